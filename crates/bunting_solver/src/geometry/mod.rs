//! Values computed from positions: normals, sums over triangles, energies.

pub(crate) mod corners;
pub(crate) mod energy;
pub(crate) mod face;
pub(crate) mod normals;
