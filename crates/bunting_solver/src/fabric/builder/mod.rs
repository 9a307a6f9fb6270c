//! Building of fabrics from triangle meshes, and of coarser meshes; repair of meshes.

mod build;
mod coarser;
#[cfg(feature = "mesh_levels")]
mod flattened;
mod repair;
mod resampled;
mod rest_normals;
#[cfg(feature = "mesh_levels")]
mod simplified;
#[cfg(feature = "mesh_levels")]
mod slivers;
mod source;
mod validate;

pub use coarser::CoarserMesh;
pub use repair::MeshRepair;
pub use resampled::{Resampled, Resolution};
pub use source::FabricBuilder;
