//! What was measured, on what, what is good and what is not: a page of HTML, and a document of Markdown
//! beside its plots.

pub mod findings;
pub mod limits;
pub mod machine;
pub mod markdown;
pub mod page;
pub mod section;
