//! Shows cloth: meshes, bounds, viewers on cameras, gizmos.

pub mod assign_meshes;
pub mod binding;
pub mod bounds;
pub mod camera_lens;
pub mod cloth_from_mesh;
mod contact_lines;
mod convert_mesh;
pub mod debug;
pub mod deformer;
mod from_mesh;
mod from_skin;
pub mod hidden;
pub mod image_region;
pub mod level_mesh;
pub mod level_meshes;
pub mod make_cloths;
mod mesh_content;
pub mod painted_regions;
pub mod painted_vertices;
pub mod painted_weights;
pub mod plugin;
pub mod source_mesh;
pub mod subdivide;
pub mod subdivided_mesh;
pub mod subdivision;
pub mod subdivisions;
pub mod tangents;
#[cfg(feature = "weave")]
pub mod weave;
pub mod write;

#[cfg(test)]
pub(crate) mod tests;
