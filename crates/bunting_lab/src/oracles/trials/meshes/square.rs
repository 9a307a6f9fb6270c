//! The square metre of most cases.

use std::sync::Arc;

use bunting_solver::{Fabric, FabricBuilder, Grid};
use glam::{DVec2, Vec3};

use crate::meshes::{Sheet, Triangulation};

pub(super) const TRIANGULATIONS: [Triangulation; 3] =
    [Triangulation::Delaunay, Triangulation::Quads, Triangulation::Scan];
/// Greatest distance of a border's particles from the border, m.
pub(super) const ROUNDING: f32 = 1e-5;

/// A square metre of about `n` × `n` particles, or the grid of as many.
pub(super) fn square(
    triangulation: Option<Triangulation>,
    n: usize,
    warp: f32,
    is_pinned: fn(Vec3) -> bool,
) -> Arc<Fabric> {
    match triangulation {
        Some(triangulation) => {
            Sheet::new(triangulation, [n, n], DVec2::ONE, 1).fabric(warp, is_pinned)
        }
        None => {
            let grid = FabricBuilder::grid(Grid::new(n as u32, n as u32, 1.0, 1.0));
            Arc::new(grid.pin_where(|at, _| is_pinned(at)).build().expect("a cloth"))
        }
    }
}

pub(super) fn at_top(at: Vec3) -> bool {
    at.y == 0.0
}

/// Whether a particle of a sheet rests at the lower end of a metre's height.
pub(super) fn at_bottom(at: Vec3) -> bool {
    at.y < -1.0 + ROUNDING
}
