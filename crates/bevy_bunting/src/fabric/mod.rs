//! Fabrics: built from meshes, one for each level of detail, and shared by cloths of equal content.

pub mod awaited;
pub mod cut;
#[cfg(feature = "render")]
pub mod level_topology;
pub mod levels;
pub mod library;
pub mod prepare;
pub mod rigid;
pub mod scale;
pub mod simulated;
pub mod transfer;
