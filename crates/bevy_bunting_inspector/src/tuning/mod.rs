//! Files of parameters.

pub mod error;
pub mod load;
mod reader;
pub mod save;
