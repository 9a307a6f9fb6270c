//! Gusts: their strength, their spectrum, the mean wind that carries them, and their bits.

use std::time::Instant;

use bevy_bunting::WindField;
use glam::{DVec3, Vec3};

use crate::{contacts::Row, golden::StateHash};

/// Strength of the gusts, m/s.
const STRENGTH: f32 = 2.0;

/// Mean wind along x, m/s, and the frequency of gusts, 1/s: gusts of 12 m.
const MEAN: f32 = 6.0;
const FREQUENCY: f32 = 0.5;
const LENGTH: f32 = MEAN / FREQUENCY;

/// Hash of the first gusts on every machine.
const BITS: u64 = 0x6334_1ddf_aa00_9080;

fn wind(seed: i32) -> WindField {
    WindField::steady(Vec3::X * MEAN).with_gusts(STRENGTH, FREQUENCY, seed)
}

/// The gust at a place (m), m/s.
fn gust(wind: &WindField, at: Vec3) -> Vec3 {
    wind.velocity_at(at, DVec3::ZERO) - wind.velocity
}

/// Places without a pattern, m.
fn places(count: u32) -> impl Iterator<Item = Vec3> {
    (0..count).map(|place| Vec3::new(7.31, 3.17, 5.03) * place as f32)
}

pub(super) fn rows(quick: bool) -> Vec<Row> {
    let seeds = if quick { 100 } else { 1000 };
    vec![strength(seeds), spectrum(seeds), carried(), same_bits()]
}

/// Row of the root mean square of gusts along an axis, which is a quarter of their strength.
fn strength(seeds: i32) -> Row {
    const PLACES: u32 = 400;
    let start = Instant::now();
    let mut sum = 0.0;
    for seed in 0..seeds {
        let wind = wind(seed);
        sum += places(PLACES).map(|at| f64::from(gust(&wind, at).length_squared())).sum::<f64>();
    }
    let count = f64::from(PLACES) * f64::from(seeds);
    let root = (sum / count / 3.0).sqrt() / f64::from(STRENGTH);
    let us = 1e6 * start.elapsed().as_secs_f64() / count;
    Row::new(
        "turbulence, strength",
        "error of the RMS, of the strength",
        (root - 0.25).abs(),
        0.02,
        us,
    )
}

/// Row of the structure function ⟨|u(x + r) − u(x)|²⟩ over 2 ⟨u²⟩ at several distances r, which for isotropic waves with
/// energies E at the wave numbers k is the mean of 1 − sin(2πkr)/(2πkr) weighted by E. Kolmogorov's energies of waves whose
/// numbers k are spaced by equal ratios are k^(−2/3); the gusts have eight from one half to two waves in their length.
fn spectrum(seeds: i32) -> Row {
    const PLACES: u32 = 100;
    let numbers: Vec<f64> = (0..8).map(|wave| 0.5 * 4.0_f64.powf(f64::from(wave) / 7.0)).collect();
    let energies: Vec<f64> = numbers.iter().map(|number| number.powf(-2.0 / 3.0)).collect();
    let start = Instant::now();
    let mut worst = 0.0_f64;
    let distances = [0.125, 0.25, 0.5, 0.75, 1.0, 2.0];
    for distance in distances {
        let (mut apart, mut square) = (0.0, 0.0);
        for seed in 0..seeds {
            let wind = wind(seed);
            for (index, at) in places(PLACES).enumerate() {
                let along = [Vec3::X, Vec3::Y, Vec3::Z][index % 3];
                let there = gust(&wind, at + along * (distance as f32 * LENGTH));
                let here = gust(&wind, at);
                apart += f64::from(here.distance_squared(there));
                square += f64::from(here.length_squared() + there.length_squared());
            }
        }
        let part = |number: &f64| {
            let phase = core::f64::consts::TAU * number * distance;
            1.0 - phase.sin() / phase
        };
        let weighted: f64 = numbers.iter().zip(&energies).map(|(k, e)| e * part(k)).sum();
        let expected = weighted / energies.iter().sum::<f64>();
        worst = worst.max((apart / square - expected).abs());
    }
    let samples = distances.len() as f64 * f64::from(PLACES) * f64::from(seeds);
    let us = 1e6 * start.elapsed().as_secs_f64() / samples;
    Row::new("turbulence, spectrum", "error of the structure function, of one", worst, 0.03, us)
}

/// Row of gusts that the mean wind carries: a place downwind feels the gust later.
fn carried() -> Row {
    let wind = wind(1);
    let at = |x: f32, seconds: f64| wind.velocity_at(Vec3::X * x, wind.travel_rate() * seconds);
    let start = Instant::now();
    let error = |step: i32| {
        let seconds = f64::from(step) * 0.37;
        let downwind = at(MEAN * 2.5, seconds + 2.5);
        f64::from(at(0.0, seconds).distance(downwind) / STRENGTH)
    };
    let worst = (0..1000).map(error).fold(0.0, f64::max);
    let us = 1e3 * start.elapsed().as_secs_f64();
    Row::new("turbulence, carried along", "error of the gust, of the strength", worst, 1e-3, us)
}

/// Row of the bits of gusts: 0 where they are those of every machine.
fn same_bits() -> Row {
    let start = Instant::now();
    let mut hash = StateHash::new();
    for seed in 0..10 {
        let wind = wind(seed);
        let gusts = places(1000)
            .zip(0..)
            .map(|(at, step)| wind.velocity_at(at, wind.travel_rate() * f64::from(step) / 60.0));
        hash.add(&gusts.collect::<Vec<_>>());
    }
    let us = 1e6 * start.elapsed().as_secs_f64() / 10_000.0;
    if hash.value() != BITS {
        eprintln!("gusts have the hash {:#x}", hash.value());
    }
    let differs = if hash.value() == BITS { 0.0 } else { 1.0 };
    Row::new("turbulence, same bits", "1 where another machine has others", differs, 0.0, us)
}
