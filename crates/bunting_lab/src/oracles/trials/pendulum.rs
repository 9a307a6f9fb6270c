//! Swings of a sheet too stiff to bend.

use glam::{DVec3, dvec3};

use crate::{
    oracles::{
        Case,
        pendulum::{amplitude_factor, stiff_period},
        rig::{YARNS, label, row, strip, substep},
    },
    scenes::{Fabric, GRAVITY, Pins, Pose, TICK_RATE, ticks},
    specimen::Mount,
    stats::crossing_frequency,
};

/// Bending stiffness, N·m: the first bending mode, 15.4 √(B/σL⁴), is 90 times as fast as the swing.
const RIGID: f64 = 100.0;
/// Links along the strip.
const SEGMENTS: usize = 8;
/// Length of the observation, s.
const SECONDS: f64 = 10.0;
/// Relative error of a period. The swing bends the strip by the square of the ratio of the frequencies,
/// 1.2e-4; strain and zero crossings by linear interpolation have errors of the same size.
const READING: f64 = 5e-4;

/// Cases of the period at four amplitudes.
pub fn cases(mount: &Mount) -> Vec<Case> {
    [1.0, 30.0, 60.0, 90.0].into_iter().map(|degrees| case(mount, degrees)).collect()
}

fn case(mount: &Mount, degrees: f64) -> Case {
    let amplitude = degrees.to_radians();
    let expected = stiff_period(GRAVITY, 1.0, Some(SEGMENTS)) * amplitude_factor(amplitude);
    // The mean of BDF2 and BDF3 slows a swing by (ωh)²/6, and by four times as much in the fastest part of a
    // large swing.
    let rate = std::f64::consts::TAU / expected;
    let phase = 4.0 * (rate * substep(YARNS)).powi(2) / 6.0;
    Case::new(
        format!("stiff pendulum {degrees}°, N = {SEGMENTS}, {}, s", label(YARNS)),
        expected,
        period(mount, amplitude),
        phase + READING,
    )
}

/// Period in seconds of a swing released at `amplitude` radians from hanging.
fn period(mount: &Mount, amplitude: f64) -> f64 {
    let fabric = Fabric { bending: RIGID, ..Fabric::STANDARD };
    let scene = strip(SEGMENTS, 1.0, Pins::Top, Pose::Vertical, fabric);
    let mut specimen = mount(&scene, YARNS);
    let (sine, cosine) = amplitude.sin_cos();
    let tilted: Vec<DVec3> =
        scene.positions().iter().map(|x| dvec3(x.x, x.y * cosine, -x.y * sine)).collect();
    specimen.place(&tilted, &vec![DVec3::ZERO; tilted.len()]);
    let angles: Vec<f64> = (0..ticks(SECONDS))
        .map(|_| {
            specimen.tick();
            let tip = row(&scene, specimen.as_ref(), SEGMENTS);
            tip.z.atan2(-tip.y)
        })
        .collect();
    crossing_frequency(&angles, f64::from(TICK_RATE)).map_or(f64::NAN, f64::recip)
}
