//! Files of parameters.

pub mod error;
pub mod load;
mod pins;
pub mod save;
mod value;
