//! Ticks of lengths other than 1/60 s.

use std::sync::Arc;

use bunting_solver::{
    ClothBatch, ClothSnapshot, Drive, Fabric, FabricBuilder, FabricMaterial, Grid, LaneCount,
    StepLimits, StepSettings,
};
use glam::Vec3;

use super::run::{GRAVITY, standard};
use crate::product::{DEFAULT, rms_speed};
use crate::stability::case::HardCase;

/// Greatest fraction of its initial energy that a swing may lose in 20 s of random ticks; equal ticks lose
/// 0.5 %.
const LOST: f64 = 0.05;
/// Greatest relative difference of a swing's period from that in ticks of 1/240 s.
const OFF_PERIOD: f64 = 0.02;
/// Greatest relative difference of the RMS speed of a flag in wind from that in ticks of 1/60 s. Flights of
/// eight flags that differ by rounding alone differ by 0.01.
const OFF_SPEED: f64 = 0.05;

/// All cases.
pub(super) fn cases() -> Vec<HardCase> {
    vec![random_ticks(), long_ticks(), ticks_in_wind()]
}

/// A square metre of n × n particles, pinned along one side.
fn sheet(n: u32, is_pinned: impl Fn(u32) -> bool) -> Arc<Fabric> {
    let pins = (0..n * n).filter(|&particle| is_pinned(particle));
    Arc::new(FabricBuilder::grid(Grid::new(n, n, 1.0, 1.0)).pin(pins).build().expect("a good grid"))
}

/// A sheet that hangs from its top edge, turned about this edge by an angle (rad), and its state.
fn turned(n: u32, angle: f32, material: FabricMaterial) -> (ClothBatch, ClothSnapshot) {
    let fabric = sheet(n, |particle| particle < n);
    let mut start = ClothSnapshot::at_rest(&fabric);
    for at in &mut start.positions {
        (at.y, at.z) = (at.y * angle.cos(), -at.y * angle.sin());
    }
    let mut batch = ClothBatch::new(fabric, LaneCount::One);
    batch.insert(&start, material).expect("a good cloth");
    let drive = Drive { gravity: Vec3::NEG_Y * GRAVITY, ..Drive::NONE };
    batch.drive(0, drive).expect("a good drive");
    (batch, start)
}

/// Case of the energy that a stiff sheet without damping loses in 20 s of swinging in random ticks.
fn random_ticks() -> HardCase {
    let n = 9;
    let stiff = FabricMaterial { bend_stiffness: 0.5, ..standard() };
    let (mut batch, start) = turned(n, 0.3, stiff);
    let fabric = Arc::clone(batch.fabric());
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
    HardCase::new(name, n as usize, "energy lost in 20 s of a swing", lost, LOST)
}

/// Case of the period of a limp sheet that swings in ticks of 1/30 s, with default substeps, relative to
/// short ticks.
fn long_ticks() -> HardCase {
    let n = 33;
    let period = |rate: f32| {
        let (mut batch, _) = turned(n, 0.3, standard());
        let mut positions = Vec::new();
        let mut side = |batch: &ClothBatch| {
            batch.copy_positions(0, &mut positions);
            positions.iter().map(|at| at.z).sum::<f32>()
        };
        let mut crossings = Vec::new();
        let mut last = side(&batch);
        for tick in 0..(4.0 * rate) as u32 {
            batch.step(1.0 / rate, StepLimits::default());
            let next = side(&batch);
            if last * next < 0.0 {
                crossings.push(f64::from((tick as f32 + last / (last - next)) / rate));
            }
            last = next;
        }
        crossings[2] - crossings[0]
    };
    let off = (period(30.0) / period(240.0) - 1.0).abs();
    HardCase::new(
        "ticks of 1/30 s",
        n as usize,
        "error of a swing's period, of one",
        off,
        OFF_PERIOD,
    )
}

/// Case of the RMS speed of flags in wind in ticks of 1/120 and 1/30 s, at 120 substeps a second, relative to
/// ticks of 1/60 s.
fn ticks_in_wind() -> HardCase {
    let n = 17;
    let fabric = sheet(n, |particle| particle % n == 0);
    let rms = |substeps: u32| {
        let mut batch = ClothBatch::new(Arc::clone(&fabric), LaneCount::Eight);
        for lane in 0..8 {
            let mut start = ClothSnapshot::at_rest(&fabric);
            for (particle, at) in start.positions.iter_mut().enumerate() {
                if !fabric.is_pinned(particle) {
                    at.z += 1e-3 * (12.9898 * particle as f32 + lane as f32).sin();
                }
            }
            batch.insert(&start, FabricMaterial::FLAG_POLYESTER).expect("a good cloth");
            let wind = Vec3::new(6.0, 0.0, 0.3);
            batch.drive(lane, Drive { wind, ..Drive::default() }).expect("a good drive");
        }
        let tick = substeps as f32 / 120.0;
        let settings = StepSettings { substeps, ..DEFAULT };
        let ticks = |seconds: f32| 0..(seconds / tick) as u32;
        ticks(3.0).for_each(|_| batch.step(tick, settings));
        let mut squares = 0.0;
        for _ in ticks(15.0) {
            batch.step(tick, settings);
            squares += (0..8).map(|lane| rms_speed(&batch, lane).powi(2)).sum::<f64>();
        }
        (squares / (8.0 * ticks(15.0).len() as f64)).sqrt()
    };
    let of_sixtieth = rms(2);
    let off = [1, 4].map(|substeps| (rms(substeps) / of_sixtieth - 1.0).abs());
    let worst = off[0].max(off[1]);
    let name = "ticks of 1/120 and 1/30 s in wind";
    HardCase::new(name, n as usize, "difference of RMS speeds, of one", worst, OFF_SPEED)
}
