//! A jump of the frame within the plane of its cloth, which must leave no cell locked.

use std::sync::Arc;

use bunting_solver::{
    ClothBatch, ClothSnapshot, Drive, Fabric, FabricBuilder, FabricMaterial, FrameMotion, Grid,
    LaneCount, Link, LinkFamily, StepSettings,
};
use glam::Vec3;

use super::run::{GRAVITY, advance};
use crate::product::{DEFAULT, TICK};
use crate::stability::case::HardCase;

/// Greatest difference of a link's strain from that of a cloth that was not jerked, percentage points.
const UNLOCKED: f64 = 0.5;
/// Lengths of the jerks, m. The last lane is not jerked.
const JERKS: [f32; 8] = [0.05, 0.1, 0.2, 0.35, 0.5, 1.0, 2.0, 0.0];
/// Directions of the jerks, within the cloth's plane. A sheet that is jerked across it swings for longer than it is
/// looked at, and swinging strains it.
const DIRECTIONS: [Vec3; 4] = [Vec3::X, Vec3::Y, Vec3::NEG_Y, Vec3::new(0.6, 0.8, 0.0)];
/// Offset of particles from the plane at the start, m: as much as the imperfection of new cloth.
const OFFSET: f32 = 1e-5;
/// Time from a jerk until strains are looked at, s.
const SETTLING: f32 = 3.0;
/// Ticks in which strains are looked at. A locked crease is strained in all of them; cloth that still swings strains
/// its links for moments.
const WATCHED: usize = 30;

/// Particles along a side, substeps of a tick, and the number of starts.
type Size = (u32, u32, u32);

/// Cases of sheets of one metre, each with the substeps that its links need.
pub(super) fn cases(quick: bool) -> Vec<HardCase> {
    let sizes: &[Size] =
        if quick { &[(17, 2, 16), (33, 2, 2)] } else { &[(17, 2, 16), (33, 2, 16), (65, 4, 4)] };
    sizes.iter().map(|&size| jerked(size)).collect()
}

/// Case of the greatest difference of strain that a link keeps from 3 s after a jerk on. The sheets hang from their top
/// edges, start with different imperfections, and are jerked in different directions by different lengths.
fn jerked((n, substeps, starts): Size) -> HardCase {
    let grid = FabricBuilder::grid(Grid::new(n, n, 1.0, 1.0)).pin(0..n);
    let fabric = Arc::new(grid.build().expect("a good grid"));
    let settings = StepSettings { substeps, ..DEFAULT };
    let flights = (0..starts).flat_map(|start| DIRECTIONS.map(|direction| (start, direction)));
    let worst = flights
        .map(|(start, direction)| kept(jerk(&fabric, start, direction, settings), settings))
        .fold(0.0, f64::max);
    let name = format!("frame jerked within the cloth's plane, {starts} starts");
    HardCase::new(name, n as usize, "strain kept from 3 s on, points", worst, UNLOCKED)
}

/// The greatest difference of strain that a link of a jerked lane keeps, in points.
fn kept(mut batch: ClothBatch, settings: StepSettings) -> f64 {
    let jerked = 0..JERKS.len() - 1;
    let mut least: Vec<Vec<f64>> = vec![Vec::new(); jerked.len()];
    for _ in 0..WATCHED {
        batch.step(TICK, settings);
        let undisturbed = strains(&batch, jerked.end);
        for lane in jerked.clone() {
            let strains = strains(&batch, lane);
            let differences =
                strains.iter().zip(&undisturbed).map(|(one, other)| (one - other).abs());
            if least[lane].is_empty() {
                least[lane] = differences.collect();
            } else {
                least[lane]
                    .iter_mut()
                    .zip(differences)
                    .for_each(|(least, now)| *least = least.min(now));
            }
        }
    }
    100.0 * least.into_iter().flatten().fold(0.0, f64::max)
}

/// Sheets of polyester that have hung for a second, 3 s after their frames were jerked.
fn jerk(fabric: &Arc<Fabric>, start: u32, direction: Vec3, settings: StepSettings) -> ClothBatch {
    let wave = 12.9898 + 0.7 * start as f32;
    let mut snapshot = ClothSnapshot::at_rest(fabric);
    for (particle, at) in snapshot.positions.iter_mut().enumerate() {
        if !fabric.is_pinned(particle) {
            at.z += OFFSET * (wave * particle as f32).sin();
        }
    }
    let still = Drive { gravity: Vec3::NEG_Y * GRAVITY, ..Drive::NONE };
    let mut batch = ClothBatch::new(Arc::clone(fabric), LaneCount::Eight);
    for _ in JERKS {
        let lane = batch.insert(&snapshot, FabricMaterial::FLAG_POLYESTER).expect("a good cloth");
        batch.drive(lane, still).expect("a good drive");
    }
    advance(&mut batch, 1.0, settings);
    for (lane, distance) in JERKS.into_iter().enumerate() {
        let motion = FrameMotion { translation: direction * distance, ..FrameMotion::NONE };
        batch.drive(lane, Drive { motion, ..still }).expect("a good drive");
    }
    batch.step(TICK, settings);
    (0..JERKS.len()).for_each(|lane| batch.drive(lane, still).expect("a good drive"));
    advance(&mut batch, SETTLING, settings);
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
