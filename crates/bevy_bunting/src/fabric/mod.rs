//! Fabrics: cut from meshes, one for each level of detail, and shared by cloths cut alike.

pub mod levels;
pub mod part;
pub mod prepare;
