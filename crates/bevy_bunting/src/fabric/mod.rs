//! Fabrics: built from meshes, one for each level of detail, and shared by cloths of equal content.

pub mod at_once;
pub(crate) mod attached;
pub mod awaited;
mod content_key;
pub mod cut;
pub mod held;
pub(crate) mod known_level;
#[cfg(feature = "render")]
pub mod level_topology;
pub mod levels;
pub mod library;
pub mod prepare;
mod refusal;
pub(crate) mod release;
pub mod rigid;
pub(crate) mod same_surface;
pub mod scale;
pub mod simulated;
pub mod transfer;
