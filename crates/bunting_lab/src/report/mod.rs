//! The report: figures, the machine, findings and limitations, as an HTML page and as a Markdown document
//! with its plots.

pub mod findings;
pub mod limits;
pub mod machine;
pub mod markdown;
pub mod page;
pub mod section;
