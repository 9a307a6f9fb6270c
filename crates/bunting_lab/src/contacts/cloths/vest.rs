//! A vest whose pins are nearer to those of a jacket than both may be.

use std::sync::Arc;

use bunting_solver::{ClothSnapshot, Drive, FabricBuilder, FabricMaterial, Grid};
use glam::Vec3;

use super::{
    super::{rig::GRAVITY, row::Row},
    together::Together,
};
use crate::product::TICK;

/// Rows of two sheets that hang 2 mm apart.
pub(super) fn rows() -> Vec<Row> {
    /// Greatest speed, m/s.
    const SPEED: f64 = 5e-3;
    let mut sheets = Together::new(true);
    let grid = FabricBuilder::grid(Grid::new(17, 17, 0.5, 0.5)).pin_where(|at, _| at.y == 0.0);
    let fabric = Arc::new(grid.build().expect("a good grid"));
    for behind in [0.0, 2e-3] {
        let start = ClothSnapshot::at_rest(&fabric);
        sheets.add(&fabric, &start, FabricMaterial::COTTON, Vec3::NEG_Z * behind, []);
    }
    for _ in 0..(6.0 / TICK) as usize {
        sheets.tick(Drive { gravity: -GRAVITY * Vec3::Y, ..Drive::default() });
    }
    let (name, us) = ("two sheets of 17² that are pinned 2 mm apart", sheets.us());
    vec![
        Row::new(format!("{name}: a tick"), "intersecting pairs", sheets.most as f64, 0.0, us),
        Row::new(format!("{name}: at rest"), "greatest speed, m/s", sheets.speed(), SPEED, us),
    ]
}
