//! A jump of the frame within the plane of its cloth, which must leave no cell locked.

use std::sync::Arc;

use bunting_solver::{
    ClothBatch, ClothSnapshot, Drive, Fabric, FabricBuilder, FabricMaterial, FrameMotion, Grid,
    LaneCount, Link, LinkFamily,
};
use glam::Vec3;

use super::{GRAVITY, advance};
use crate::product::{DEFAULT, TICK};
use crate::stability::case::HardCase;

/// Greatest difference of a link's strain from that of a cloth that was not jerked, percentage points.
const UNLOCKED: f64 = 0.5;
/// Lengths of the jerks, m. The last lane is not jerked.
const JERKS: [f32; 8] = [0.05, 0.1, 0.2, 0.35, 0.5, 1.0, 2.0, 0.0];
/// Offset of particles from the plane at the start, m: that of an imperfection in real cloth.
const OFFSET: f32 = 1e-5;

/// Cases of sheets of one metre.
pub(super) fn cases(quick: bool) -> Vec<HardCase> {
    let sizes: &[u32] = if quick { &[17] } else { &[17, 33] };
    sizes.iter().map(|&n| jerked(n)).collect()
}

/// Case of the greatest difference of strains 3 s after a jerk within the plane of a sheet that hangs from
/// its top edge.
fn jerked(n: u32) -> HardCase {
    let grid = FabricBuilder::grid(Grid::new(n, n, 1.0, 1.0)).pin(0..n);
    let fabric = Arc::new(grid.build().expect("a good grid"));
    let mut worst: f64 = 0.0;
    for direction in [Vec3::X, Vec3::Y, Vec3::NEG_Y, Vec3::new(0.6, 0.8, 0.0)] {
        let batch = jerk(&fabric, direction);
        let undisturbed = strains(&batch, JERKS.len() - 1);
        for lane in 0..JERKS.len() - 1 {
            let differences = strains(&batch, lane).into_iter().zip(&undisturbed);
            worst =
                differences.map(|(one, other)| 100.0 * (one - other).abs()).fold(worst, f64::max);
        }
    }
    let name = "frame jerked within the cloth's plane";
    HardCase::new(name, n as usize, "strain against rest after 3 s, points", worst, UNLOCKED)
}

/// Sheets of polyester that have hung for a second, 3 s after their frames were jerked.
fn jerk(fabric: &Arc<Fabric>, direction: Vec3) -> ClothBatch {
    let mut start = ClothSnapshot::at_rest(fabric);
    for (particle, at) in start.positions.iter_mut().enumerate() {
        if !fabric.is_pinned(particle) {
            at.z += OFFSET * (12.9898 * particle as f32).sin();
        }
    }
    let still = Drive { gravity: Vec3::NEG_Y * GRAVITY, ..Drive::NONE };
    let mut batch = ClothBatch::new(Arc::clone(fabric), LaneCount::Eight);
    for _ in JERKS {
        let lane = batch.insert(&start, FabricMaterial::FLAG_POLYESTER).expect("a good cloth");
        batch.drive(lane, still).expect("a good drive");
    }
    advance(&mut batch, 1.0, DEFAULT);
    for (lane, distance) in JERKS.into_iter().enumerate() {
        let motion = FrameMotion { translation: direction * distance, ..FrameMotion::NONE };
        batch.drive(lane, Drive { motion, ..still }).expect("a good drive");
    }
    batch.step(TICK, DEFAULT);
    (0..JERKS.len()).for_each(|lane| batch.drive(lane, still).expect("a good drive"));
    advance(&mut batch, 3.0, DEFAULT);
    batch
}

/// Strain of each link of warp and weft.
fn strains(batch: &ClothBatch, lane: usize) -> Vec<f64> {
    let mut positions = Vec::new();
    batch.copy_positions(lane, &mut positions);
    let strain = |link: &Link| {
        let [a, b] = link.particles.map(|particle| positions[particle as usize]);
        f64::from(a.distance(b) / link.rest_length - 1.0)
    };
    let links = batch.fabric().links().iter();
    links.filter(|link| link.family != LinkFamily::Diagonal).map(strain).collect()
}
