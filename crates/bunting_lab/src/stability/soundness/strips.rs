//! Stiff strips under their own weight, which must come to rest.

use std::sync::Arc;

use bunting_solver::{
    ClothBatch, ClothSnapshot, Drive, FabricBuilder, FabricMaterial, Grid, LaneCount, StepSettings,
};
use glam::Vec3;

use super::run::{AT_REST, GRAVITY, advance, fastest, standard};
use crate::product::DEFAULT;
use crate::stability::case::HardCase;

/// Particles along a strip of a metre.
const ROWS: u32 = 33;
/// Loads Γ = σ g L³/B of the strips.
const LOADS: [f32; 8] = [5.0, 10.0, 15.0, 20.0, 30.0, 50.0, 70.0, 100.0];

/// Cases of cantilevers of two and more columns.
pub(super) fn cases(quick: bool) -> Vec<HardCase> {
    let columns: &[u32] = if quick { &[2] } else { &[2, 3, 5, 17] };
    columns.iter().map(|&columns| cantilever(columns)).collect()
}

/// Case of the RMS speed of clamped cantilevers after 10 s, with one to eight substeps.
fn cantilever(columns: u32) -> HardCase {
    let width = (columns - 1) as f32 / (ROWS - 1) as f32;
    let grid = FabricBuilder::grid(Grid::new(columns, ROWS, width, 1.0)).pin(0..2 * columns);
    let fabric = Arc::new(grid.build().expect("a good grid"));
    let gravity = Vec3::new(0.0, 0.0, -GRAVITY);
    let mut worst: f64 = 0.0;
    for substeps in [1, 2, 3, 8] {
        let mut batch = ClothBatch::new(Arc::clone(&fabric), LaneCount::Eight);
        for load in LOADS {
            let material = FabricMaterial {
                warp_stiffness: 1e5,
                weft_stiffness: 1e5,
                bend_stiffness: standard().area_density * GRAVITY / load,
                damping: 4.0,
                ..standard()
            };
            let rest = ClothSnapshot::at_rest(&fabric);
            let lane = batch.insert(&rest, material).expect("a good cloth");
            batch.drive(lane, Drive { gravity, ..Drive::NONE }).expect("a good drive");
        }
        advance(&mut batch, 10.0, StepSettings { substeps, ..DEFAULT });
        worst = worst.max(fastest(&batch));
    }
    let name = format!("stiff cantilever of {columns} columns");
    HardCase::new(name, ROWS as usize, "RMS speed after 10 s, m/s", worst, AT_REST)
}
