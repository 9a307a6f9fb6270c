//! Ticks of varying lengths.

use std::sync::Arc;

use bunting_solver::{
    ClothBatch, ClothSnapshot, Drive, FabricBuilder, FabricMaterial, Grid, LaneCount,
};
use glam::Vec3;

use super::{GRAVITY, standard};
use crate::product::DEFAULT;
use crate::stability::case::HardCase;

/// Vertices along each side of the sheet.
const SIZE: u32 = 9;
/// Most energy that a swing may lose in 20 s of random ticks, as a part of that at the start; 0.5 % in equal ones.
const LOST: f64 = 0.05;

/// Energy that a stiff sheet of a metre, without damping, loses in 20 s of swinging by its top edge in random ticks.
pub(super) fn random_ticks() -> HardCase {
    let grid = FabricBuilder::grid(Grid::new(SIZE, SIZE, 1.0, 1.0)).pin(0..SIZE);
    let fabric = Arc::new(grid.build().expect("a good grid"));
    let mut start = ClothSnapshot::at_rest(&fabric);
    for at in &mut start.positions {
        (at.y, at.z) = (at.y * 0.3_f32.cos(), -at.y * 0.3_f32.sin());
    }
    let material = FabricMaterial { bend_stiffness: 0.5, ..standard() };
    let mut batch = ClothBatch::new(Arc::clone(&fabric), LaneCount::Eight);
    batch.insert(&start, material).expect("a good cloth");
    let drive = Drive { gravity: Vec3::NEG_Y * GRAVITY, ..Drive::NONE };
    batch.drive(0, drive).expect("a good drive");
    let energy = |state: &ClothSnapshot| -> f64 {
        let particles = state.velocities.iter().zip(&state.positions).zip(fabric.rest_positions());
        let of_mass =
            particles.map(|((v, x), rest)| 0.5 * v.length_squared() + GRAVITY * (x.y - rest.y));
        of_mass.zip(fabric.particle_areas()).map(|(energy, area)| f64::from(energy * area)).sum()
    };
    let (mut time, mut seed) = (0.0, 1_u32);
    while time < 20.0 {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let rate = 54.0 + 12.0 * (seed >> 8) as f32 / 16_777_216.0;
        batch.step(1.0 / rate, DEFAULT);
        time += 1.0 / rate;
    }
    let lost = 1.0 - energy(&batch.snapshot(0)) / energy(&start);
    let name = "ticks of 1/66 to 1/54 s";
    HardCase::new(name, SIZE as usize, "energy lost in 20 s of a swing", lost, LOST)
}
