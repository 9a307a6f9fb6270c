//! A sheet that lies on another one, whose border is held.

use std::sync::Arc;

use bunting_solver::{ClothSnapshot, Drive, FabricBuilder, FabricMaterial, Grid};
use glam::Vec3;

use super::{
    super::{rig::GRAVITY, row::Row},
    together::Together,
};
use crate::product::TICK;

/// Row of the speed at which the sheets tremble.
pub(super) fn row() -> Row {
    /// Greatest speed, m/s.
    const SPEED: f64 = 0.01;
    let sheets = lain(4.0);
    let name = "a sheet of 13² on one of 17² whose border is held: at rest";
    Row::new(name, "greatest speed, m/s", sheets.speed(), SPEED, sheets.us())
}

/// Lays a sheet on the other one, and waits for some seconds.
fn lain(seconds: f32) -> Together {
    let mut sheets = Together::new(true);
    for (particles, size, height) in [(17, 0.5, 0.0), (13, 0.4, 0.01)] {
        let mut grid = FabricBuilder::grid(Grid::new(particles, particles, size, size));
        if height == 0.0 {
            let at_border = |at: f32| at == 0.0 || at == 1.0;
            grid = grid.pin_where(move |_, uv| at_border(uv.x) || at_border(uv.y));
        }
        let fabric = Arc::new(grid.build().expect("a good grid"));
        let start = ClothSnapshot::at_rest(&fabric);
        let at = Vec3::new(height, -height, height);
        sheets.add(&fabric, &start, FabricMaterial::FLAG_POLYESTER, at, []);
    }
    // The sheets are in the plane z = 0.
    for _ in 0..(seconds / TICK) as usize {
        sheets.tick(Drive { gravity: -GRAVITY * Vec3::Z, ..Drive::NONE });
    }
    sheets
}
