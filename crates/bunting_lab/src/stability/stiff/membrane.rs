//! A square membrane with its border drawn out: its frequency follows from its tension.

use std::f64::consts::PI;
use std::sync::Arc;

use bunting_solver::{ClothSnapshot, Drive, FabricBuilder, FabricMaterial, Grid};
use glam::Vec3;

use crate::{
    scenes::{TICK_RATE, ticks},
    stability::{case::HardCase, lone::Lone},
    stats::crossing_frequency,
};

/// Particles along each side.
const SIZE: u32 = 33;
/// Stiffness of warp and weft, N/m.
const STRETCH: f64 = 1e4;
/// Area density, kg/m².
const DENSITY: f64 = 0.1;
/// Height of the first mode at the start, m.
const HEIGHT: f64 = 1e-3;
/// Time for which it sings, s.
const SECONDS: f64 = 5.0;
/// Strains of the border, and the error of the frequency that each may have, %. The last frequency is 22 Hz, of which a
/// tick of 1/60 s is a third of a period.
const STRAINS: [(f64, f64); 3] = [(5e-4, 3.0), (2e-3, 3.0), (1e-2, 10.0)];

pub(super) fn cases() -> impl Iterator<Item = HardCase> {
    STRAINS.into_iter().map(|(strain, limit)| {
        let expected = first_frequency(strain);
        let error = 100.0 * (frequency(strain) / expected - 1.0).abs();
        let name = format!("membrane at {} % tension", 100.0 * strain);
        HardCase::new(name, SIZE as usize, "error of the first frequency, %", error, limit)
    })
}

/// Frequency of the first mode of a square metre drawn out by a strain ε along both sides, Hz: c/(√2 L) with c² = T/σ,
/// T = Yε/(1 + ε), σ₀/(1 + ε)² for σ and L = 1 + ε.
fn first_frequency(strain: f64) -> f64 {
    (STRETCH * strain / (DENSITY * (1.0 + strain)) / 2.0).sqrt()
}

/// Measured frequency of the first mode, Hz; NaN if it does not vibrate.
fn frequency(strain: f64) -> f64 {
    let is_border =
        |at: Vec3| [at.x, -at.y].into_iter().any(|place| !(1e-6..1.0 - 1e-6).contains(&place));
    let grid = FabricBuilder::grid(Grid::new(SIZE, SIZE, 1.0, 1.0));
    let fabric = Arc::new(grid.pin_where(|at, _| is_border(at)).build().expect("a good grid"));
    let mode = |at: &Vec3| (PI * f64::from(at.x)).sin() * (PI * f64::from(-at.y)).sin();
    let shape: Vec<f64> = fabric.rest_positions().iter().map(mode).collect();
    let mut start = ClothSnapshot::at_rest(&fabric);
    for (at, height) in start.positions.iter_mut().zip(&shape) {
        *at *= 1.0 + strain as f32;
        at.z = (HEIGHT * height) as f32;
    }
    let material = FabricMaterial {
        area_density: DENSITY as f32,
        warp_stiffness: STRETCH as f32,
        weft_stiffness: STRETCH as f32,
        shear_stiffness: 0.5 * STRETCH as f32,
        bend_stiffness: 0.0,
        damping: 0.0,
        ..FabricMaterial::FLAG_POLYESTER
    };
    let mut membrane = Lone::new(&fabric, &start, material, Drive::NONE);
    let heights: Vec<f64> = (0..ticks(SECONDS))
        .map(|_| {
            membrane.tick();
            let pairs = membrane.positions.iter().zip(&shape);
            pairs.map(|(at, part)| f64::from(at.z) * part).sum()
        })
        .collect();
    crossing_frequency(&heights, f64::from(TICK_RATE)).unwrap_or(f64::NAN)
}
