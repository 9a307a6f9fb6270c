//! Cloth on skeletons: joints, animated places of particles, limits around them.

pub mod by_vertex;
pub mod check;
pub mod joints;
pub mod lead;
pub mod limits;
pub mod particles;
pub mod plugin;
pub mod show;
pub mod skin;
mod skinned_particle;
mod vertex_skins;
