//! Every method on the same scenes: time and error of each.

pub mod measurement;
pub mod meshes;
pub mod row;
pub mod speed_error;
