//! Building of fabrics from triangle meshes, and of coarser meshes.

mod build;
mod coarser;
mod rest_normals;
mod slivers;
mod source;
mod validate;

pub use coarser::CoarserMesh;
pub use source::FabricBuilder;
