//! From a triangle mesh to a fabric, and from a mesh to the next coarser one.

mod build;
mod coarser;
mod rest_normals;
mod slivers;
mod source;
mod validate;

pub use coarser::CoarserMesh;
pub use source::FabricBuilder;
