//! A strip that spins stretches.

use glam::DVec3;

use crate::{
    oracles::{
        Case,
        rig::{YARNS, chains, label, row, run, strip, substep},
        specimen::Mount,
        stretch::{free_spinning_strip, spinning_strip},
    },
    scenes::{Pins, Pose, Scene},
};

/// Rate of the frame, rad/s.
const RATE: f64 = 20.0;
/// Links along the strip.
const SEGMENTS: usize = 32;
/// Stiffness, N/m: a strain of 0.3 %.
const STIFF: f64 = 1e4;
/// Time to come to rest in the turning frame, s.
const SETTLING: f64 = 3.0;
/// Damping relative to the turning frame, which keeps up its spin, 1/s.
const DAMPING: f64 = 10.0;

/// Held at its end, and free about its middle.
pub fn cases(mount: &Mount) -> Vec<Case> {
    let density = chains(STIFF).density;
    let cases = [
        ("held at its axis", Pins::Top, 0.0, spinning_strip(density, RATE, 1.0, STIFF)),
        ("free about its middle", Pins::Free, 0.5, free_spinning_strip(density, RATE, 1.0, STIFF)),
    ];
    cases
        .into_iter()
        .map(|(name, pins, above, expected)| {
            // A circle in steps of ωh is a polygon, of second order; the stretched strip is longer
            // by its strain, and its force grows by as much.
            let tolerance = (RATE * substep(YARNS)).powi(2) + 3.0 * expected + lumping();
            Case::new(
                format!("strip spinning {name}, N = {SEGMENTS}, {}, m", label(YARNS)),
                expected,
                elongation(mount, pins, above),
                tolerance,
            )
        })
        .collect()
}

/// Lumped masses carry the load of the continuum to second order.
fn lumping() -> f64 {
    1.0 / (SEGMENTS * SEGMENTS) as f64
}

/// Elongation in metres of the strip whose upper end is `above` the axis.
fn elongation(mount: &Mount, pins: Pins, above: f64) -> f64 {
    let strip = strip(SEGMENTS, 1.0, pins, Pose::Vertical, chains(STIFF));
    let scene = Scene { gravity: 0.0, damping: DAMPING, ..strip };
    let mut specimen = mount(&scene, YARNS);
    let positions: Vec<DVec3> = scene.positions().iter().map(|x| *x + DVec3::Y * above).collect();
    let velocities: Vec<DVec3> = positions.iter().map(|x| (DVec3::X * RATE).cross(*x)).collect();
    specimen.place(&positions, &velocities);
    specimen.spin(RATE);
    run(specimen.as_mut(), SETTLING);
    let ends = [0, SEGMENTS].map(|end| row(&scene, specimen.as_ref(), end));
    ends[0].distance(ends[1]) - 1.0
}
