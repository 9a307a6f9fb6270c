//! A spinning strip stretches.

use glam::DVec3;

use crate::{
    oracles::{
        Case,
        rig::{YARNS, chains, label, row, strip, substep},
        stretch::{free_spinning_strip, spinning_strip},
    },
    scenes::{Pins, Pose, Scene, TICK_RATE},
    specimen::{Mount, Specimen},
    stats::mean,
};

/// Rate at the start, rad/s.
const RATE: f64 = 20.0;
/// Links along the strip. Link directions are frozen within a substep, which is stable up to h² T/(m l) of
/// about 36/55: with three substeps eight links are at 0.4, and sixteen beyond the limit.
const SEGMENTS: usize = 8;
/// Stiffness, N/m: a strain of 0.3 %.
const STIFF: f64 = 1e4;
/// Ticks in which the initial oscillation decays, and ticks over which the elongation is then measured.
const TICKS: [u32; 2] = [TICK_RATE, TICK_RATE];

/// Elongation in metres by density, rate, length and stiffness.
type Elongation = fn(f64, f64, f64, f64) -> f64;

/// Cases of a strip held at its end, and free about its middle.
pub fn cases(mount: &Mount) -> Vec<Case> {
    let forms: [(&str, Pins, f64, Elongation); 2] = [
        ("held at its axis", Pins::Top, 0.0, spinning_strip),
        ("free about its middle", Pins::Free, 0.5, free_spinning_strip),
    ];
    forms
        .into_iter()
        .map(|(name, pins, above, form)| {
            let (elongation, rate) = spin(mount, pins, above);
            let expected = form(chains(STIFF).density, rate, 1.0, STIFF);
            // A circle in steps of ωh is a polygon; the stretched strip is longer by its strain, and its load
            // grows by the same factor; lumped masses are the trapezium rule of ∫r² dr.
            let lumping = (0.5 / above.max(0.5)).powi(2) / (SEGMENTS * SEGMENTS) as f64;
            let tolerance = (RATE * substep(YARNS)).powi(2) + 3.0 * expected + 2.0 * lumping;
            Case::new(
                format!("strip spinning {name}, N = {SEGMENTS}, {}, m", label(YARNS)),
                expected,
                elongation,
                tolerance,
            )
        })
        .collect()
}

/// Mean elongation in metres of the strip whose upper end is `above` the axis, and its mean rate in rad/s.
fn spin(mount: &Mount, pins: Pins, above: f64) -> (f64, f64) {
    let strip = strip(SEGMENTS, 1.0, pins, Pose::Vertical, chains(STIFF));
    let scene = Scene { gravity: 0.0, ..strip };
    let mut specimen = mount(&scene, YARNS);
    let positions: Vec<DVec3> = scene.positions().iter().map(|x| *x + DVec3::Y * above).collect();
    let velocities: Vec<DVec3> = positions.iter().map(|x| (DVec3::X * RATE).cross(*x)).collect();
    specimen.place(&positions, &velocities);
    let [settling, reading] = TICKS;
    (0..settling).for_each(|_| specimen.tick());
    let (mut elongations, mut rates) = (Vec::new(), Vec::new());
    for _ in 0..reading {
        specimen.tick();
        let length =
            (row(&scene, specimen.as_ref(), 0) - row(&scene, specimen.as_ref(), SEGMENTS)).length();
        elongations.push(length - 1.0);
        rates.push(relative_speed(&scene, specimen.as_ref()) / length);
    }
    (mean(&elongations), mean(&rates))
}

/// Speed of one end relative to the other, m/s.
fn relative_speed(scene: &Scene, specimen: &dyn Specimen) -> f64 {
    let velocities = specimen.velocities();
    velocities[SEGMENTS * scene.columns].distance(velocities[0]).into()
}
