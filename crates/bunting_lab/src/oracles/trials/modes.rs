//! Small swings of a limp sheet that hangs.

use std::f64::consts::PI;

use bunting_solver::{Scheme, StepSettings};
use glam::{DVec3, dvec3};

use crate::{
    oracles::{
        Case,
        pendulum::{Mode, modes_of_chain},
        rig::{GAUSS_SEIDEL, YARNS, chains, column_masses, label, strip, substep},
    },
    scenes::{GRAVITY, Pins, Pose, Scene, TICK_RATE, ticks},
    specimen::Mount,
    stats::crossing_frequency,
};

/// Stiffness of the strip, N/m: it strains by 1e-6 on average.
const STIFF: f64 = 1e6;
/// Largest displacement at the start, m: a slope of a few thousandths.
const AMPLITUDE: f64 = 0.001;
/// Length of the observation, s.
const SECONDS: f64 = 10.0;
/// Relative error of a frequency. Strain and the square of the slope change it by 1e-5; zero crossings by
/// linear interpolation are off by 1e-3 of a period, over 6 periods and more.
const READING: f64 = 2e-4;

/// Cases of the first three modes at two sizes, and of the third at other numbers of substeps.
pub fn cases(mount: &Mount) -> Vec<Case> {
    let mut cases = Vec::new();
    for segments in [8, 32] {
        for mode in 0..3 {
            cases.push(case(mount, segments, mode, YARNS));
        }
    }
    cases.push(case(mount, 8, 0, GAUSS_SEIDEL));
    // The error at two substeps is already below the resolution, so that further ones show no order.
    for substeps in [4, 8] {
        cases.push(case(mount, 32, 2, StepSettings::yarns(substeps)));
    }
    cases
}

fn case(mount: &Mount, segments: usize, mode: usize, settings: StepSettings) -> Case {
    let scene = strip(segments, 1.0, Pins::Top, Pose::Vertical, chains(STIFF));
    let masses = column_masses(&scene);
    let mode_shape = modes_of_chain(&masses).swap_remove(mode);
    let rate = mode_shape.rate * GRAVITY.sqrt();
    // Backward Euler slows a swing by (ωh)²/3, the mean of BDF2 and BDF3 by half of that.
    let slowed = match settings.scheme {
        Scheme::GaussSeidel => 3.0,
        Scheme::Yarns => 6.0,
    };
    let phase = (rate * substep(settings)).powi(2) / slowed;
    Case::new(
        format!("hanging mode {}, N = {segments}, {}, rad/s", mode + 1, label(settings)),
        rate,
        2.0 * PI * frequency(mount, &scene, &masses, &mode_shape, settings),
        phase + READING,
    )
}

/// Frequency in Hz of the first column's motion in the mode.
fn frequency(
    mount: &Mount,
    scene: &Scene,
    masses: &[f64],
    mode: &Mode,
    settings: StepSettings,
) -> f64 {
    let mut specimen = mount(scene, settings);
    let largest = mode.shape.iter().map(|z| z.abs()).fold(0.0, f64::max);
    let shaped: Vec<DVec3> = scene
        .positions()
        .iter()
        .enumerate()
        .map(|(vertex, x)| match (vertex / 2).checked_sub(1) {
            Some(row) => dvec3(x.x, x.y, AMPLITUDE * mode.shape[row] / largest),
            None => *x,
        })
        .collect();
    specimen.place(&shaped, &vec![DVec3::ZERO; shaped.len()]);
    let signal: Vec<f64> = (0..ticks(SECONDS))
        .map(|_| {
            specimen.tick();
            let column = specimen.positions().iter().step_by(2).skip(1);
            let parts = column.zip(masses).zip(&mode.shape);
            parts.map(|((x, mass), shape)| f64::from(x.z) * mass * shape).sum()
        })
        .collect();
    crossing_frequency(&signal, f64::from(TICK_RATE)).unwrap_or(f64::NAN)
}
