//! Guides: a bob within a greatest distance of its place swings like a pendulum, and gains no energy.

use std::f64::consts::TAU;
use std::sync::Arc;
use std::time::Instant;

use bunting_solver::{
    Backstop, ClothBatch, ClothSnapshot, Drive, FabricBuilder, FabricMaterial, Grid, Guide,
    LaneCount, StepSettings,
};
use glam::Vec3;

use crate::contacts::Row;
use crate::product::TICK;

/// Gravity, m/s².
const GRAVITY: f64 = 9.81;

/// Amplitude of the swing whose period is measured, rad.
const SMALL: f64 = 0.1;

/// Amplitude of the swing whose energy is measured, rad: the bob begins above its place and falls until the limit is taut.
const LARGE: f64 = 2.5;

/// Greatest error of the period, of one.
const PERIOD: f64 = 5e-3;

/// Greatest gain of energy, as height, m.
const GAIN: f64 = 2e-3;

/// Number of substeps in a tick.
const SUBSTEPS: u32 = 8;

pub(super) fn rows(quick: bool) -> Vec<Row> {
    let seconds = if quick { 10.0 } else { 30.0 };
    vec![period(seconds), gain(seconds)]
}

/// The way and the speed of a bob of a square centimetre within a metre of its place, from rest at an angle (rad); and the
/// time of a tick, µs.
fn swing(angle: f64, seconds: f32) -> (Vec<(Vec3, f32)>, f64) {
    let fabric = FabricBuilder::grid(Grid::new(2, 2, 0.01, 0.01)).build().expect("a good fabric");
    let fabric = Arc::new(fabric);
    let rest = fabric.rest_positions();
    let arm = Vec3::new(angle.sin() as f32, -angle.cos() as f32, 0.0);
    let start = rest.iter().map(|&at| at + arm).collect();
    let snapshot = ClothSnapshot::new(start, vec![Vec3::ZERO; rest.len()]);
    let polyester = FabricMaterial::FLAG_POLYESTER;
    let undamped = FabricMaterial { damping: 0.0, internal_damping: 0.0, ..polyester };
    let mut batch = ClothBatch::new(Arc::clone(&fabric), LaneCount::Eight);
    let lane = batch.insert(&snapshot, undamped).expect("a good cloth");
    let vacuum = Drive { air_density: 0.0, ..Drive::default() };
    batch.drive(lane, vacuum).expect("a good drive");
    let guide = |&place: &Vec3| Guide {
        places: [place; 2],
        normals: [Vec3::Z; 2],
        max_distance: 1.0,
        backstop: Backstop::default(),
    };
    batch.set_guides(lane, rest.iter().map(guide).collect()).expect("good guides");
    let settings = StepSettings { substeps: SUBSTEPS, ..StepSettings::default() };
    let ticks = (seconds / TICK) as usize;
    let began = Instant::now();
    let way = (0..ticks).map(|_| {
        batch.step(TICK, settings);
        let state = batch.snapshot(lane);
        (state.positions[0] - rest[0], state.velocities[0].length())
    });
    let way = way.collect();
    (way, 1e6 * began.elapsed().as_secs_f64() / ticks as f64)
}

/// Row of the period of a small swing, from one passage through the lowest point to the left to the next.
fn period(seconds: f32) -> Row {
    let (way, us) = swing(SMALL, seconds);
    let passages = way.windows(2).enumerate().filter_map(|(tick, ends)| {
        let [before, after] = [ends[0].0.x, ends[1].0.x];
        (before > 0.0 && after <= 0.0).then(|| tick as f64 + f64::from(before / (before - after)))
    });
    let passages: Vec<f64> = passages.collect();
    let turns = passages.len() - 1;
    let period = (passages[turns] - passages[0]) * f64::from(TICK) / turns as f64;
    let expected = TAU / GRAVITY.sqrt() * (1.0 + SMALL * SMALL / 16.0);
    let error = (period / expected - 1.0).abs();
    Row::new("guides, bob on a taut limit", "error of the period, of one", error, PERIOD, us)
}

/// Row of the greatest energy of a bob that falls onto its limit and swings, less that at the start.
fn gain(seconds: f32) -> Row {
    let (way, us) = swing(LARGE, seconds);
    let energy = |&(at, speed): &(Vec3, f32)| {
        f64::from(at.y) + f64::from(speed) * f64::from(speed) / (2.0 * GRAVITY)
    };
    let greatest = way.iter().map(energy).fold(f64::NEG_INFINITY, f64::max);
    let gain = (greatest + LARGE.cos()).max(0.0);
    Row::new("guides, bob that falls onto its limit", "energy gained, m of height", gain, GAIN, us)
}
