//! Building of fabrics from triangle meshes, and of coarser meshes; repair of meshes.

mod build;
mod coarser;
mod mesh_point;
mod on_surface;
mod points;
mod rectangle;
mod regions;
mod repair;
mod resampled;
mod rest_normals;
mod source;
mod validate;

pub use coarser::CoarserMesh;
pub use mesh_point::MeshPoint;
pub use repair::MeshRepair;
pub use resampled::{Resampled, Resolution};
pub use source::FabricBuilder;
