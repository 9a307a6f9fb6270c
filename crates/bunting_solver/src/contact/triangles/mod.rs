//! Surfaces of many triangles, which are meshes and heightfields, near the cloth.
//!
//! A search in the whole surface for each particle and pass costs more than all else that a cloth does. Where a cloth has come, a sparse grid
//! keeps the few triangles near each cell instead (`cells.rs`), of which the nearest is found eight at a time (`block.rs`). Those near each particle
//! are put into the lanes of its pack once a tick (`lanes.rs`).
//! `surface.rs` tells what a mesh and a heightfield have in common.

mod block;
mod cells;
mod lanes;
mod surface;
#[cfg(test)]
mod tests;

pub(super) use self::cells::Near;
pub(crate) use self::cells::TriangleCells;
pub(super) use self::lanes::LaneTriangles;
