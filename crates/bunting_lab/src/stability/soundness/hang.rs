//! Cloth that has hung without air until nothing moves: its ticks must take no longer than at the start.

use std::sync::Arc;
use std::time::Instant;

use bunting_solver::{
    ClothBatch, ClothSnapshot, Drive, FabricBuilder, FabricMaterial, Grid, LaneCount,
};
use glam::Vec3;

use super::run::{GRAVITY, advance};
use crate::product::{DEFAULT, TICK};
use crate::stability::case::HardCase;

/// Greatest ratio of a tick's time to that at the start.
const SLOWER: f64 = 1.2;
/// Magnitude below which products of two values are subnormal, and processors slow. Positions are in m,
/// velocities in m/s.
const SLOW: f32 = 1e-19;
/// Number of ticks of which the shortest is taken, since other programs use the machine, too.
const TIMED: usize = 300;

/// Cases of subnormal numbers and, unless `quick`, of the time of a tick.
pub(super) fn cases(quick: bool) -> Vec<HardCase> {
    let mut cases = vec![slow_numbers()];
    if !quick {
        cases.push(time());
    }
    cases
}

/// A sheet of polyester that hangs from its top edge, with a ripple of a millimetre.
fn hung(n: u32) -> ClothBatch {
    let grid = FabricBuilder::grid(Grid::new(n, n, 1.0, 1.0)).pin(0..n);
    let fabric = Arc::new(grid.build().expect("a good grid"));
    let mut start = ClothSnapshot::at_rest(&fabric);
    for (particle, at) in start.positions.iter_mut().enumerate() {
        if !fabric.is_pinned(particle) {
            at.z += 1e-3 * (5.0 * at.x).sin();
        }
    }
    let mut batch = ClothBatch::new(fabric, LaneCount::One);
    let material = FabricMaterial { damping: 2.0, ..FabricMaterial::FLAG_POLYESTER };
    batch.insert(&start, material).expect("a good cloth");
    let drive = Drive { gravity: Vec3::NEG_Y * GRAVITY, ..Drive::NONE };
    batch.drive(0, drive).expect("a good drive");
    batch
}

/// Case of the fraction of the coordinates of positions and velocities that are not zero but whose squares
/// are subnormal.
fn slow_numbers() -> HardCase {
    let n = 9;
    let mut batch = hung(n);
    advance(&mut batch, 100.0, DEFAULT);
    let state = batch.snapshot(0);
    let vectors = state.positions.iter().chain(&state.velocities);
    let numbers: Vec<f32> = vectors.flat_map(|vector| vector.to_array()).collect();
    let slow = numbers.iter().filter(|number| **number != 0.0 && number.abs() < SLOW).count();
    let part = slow as f64 / numbers.len() as f64;
    HardCase::new(
        "hangs for 100 s",
        n as usize,
        "part of numbers with subnormal squares",
        part,
        0.0,
    )
}

/// Case of the time of a tick, relative to that at the start.
fn time() -> HardCase {
    let n = 33;
    let mut batch = hung(n);
    let shortest = |batch: &mut ClothBatch| {
        let ticks = (0..TIMED).map(|_| {
            let begin = Instant::now();
            batch.step(TICK, DEFAULT);
            begin.elapsed().as_secs_f64()
        });
        ticks.fold(f64::INFINITY, f64::min)
    };
    let first = shortest(&mut batch);
    advance(&mut batch, 100.0, DEFAULT);
    let ratio = shortest(&mut batch) / first;
    HardCase::new(
        "hangs for 105 s",
        n as usize,
        "time of a tick against the first's",
        ratio,
        SLOWER,
    )
}
