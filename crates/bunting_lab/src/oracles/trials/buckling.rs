//! Strips that buckle under their own weight: the load beyond which a small perturbation grows.

use std::f64::consts::{FRAC_PI_2, SQRT_2};

use bunting_solver::StepSettings;
use glam::{DVec3, dvec3};

use crate::{
    oracles::{
        Case,
        bending::{LATERAL_BUCKLING, SELF_WEIGHT_COLUMN, column_of_links},
        rig::{YARNS, chains, label, order, row, strip},
        root::bisect_times,
    },
    reference::grid::Grid,
    scenes::{Fabric, GRAVITY, Pins, Pose, Scene, ticks},
    simulation::run,
    specimen::Mount,
};

/// Links along the free metre of a column.
const COLUMNS: [usize; 5] = [2, 4, 8, 16, 32];
/// Number of column sizes, from the first on, over which the order is observed: beyond them the step's error
/// dominates.
const ORDERED: usize = 3;
/// Links along the free metre of a strip on edge.
const ON_EDGE: [usize; 3] = [8, 16, 32];
/// Relative rise of the critical load of a strip on edge of square cells by restrained warping, times N. At
/// the clamp the hinges stiffen the first cell's twist by a quarter, which raises the load by three times a
/// fifth of a cell. The stencil lowers it by 0.5/N².
const WARPING: f64 = 0.6;
/// Factor on the known error within which a case passes.
const MARGIN: f64 = 1.5;
/// Relative error of a measured load: link directions are frozen at the predicted positions, the strip
/// strains, and a perturbation may grow too slowly to be seen within the run.
const READING: f64 = 2e-3;
/// Initial sideways displacement of the tip, m.
const PERTURBATION: f64 = 1e-4;
/// Ratio of the displacement to the perturbation above which the perturbation has grown: a stable mode
/// oscillates within its initial amplitude.
const GROWN: f64 = 2.0;
/// Longest run, s: a load 0.1 ‰ above the critical one doubles the perturbation in this time.
const SECONDS: f64 = 40.0;
/// Damping while the load settles, 1/s.
const DAMPING: f64 = 4.0;
/// Time in which the load settles, s.
const SETTLING: f64 = 3.0;
/// Number of bisections of the interval of loads from zero to twice the expected load.
const HALVINGS: u32 = 16;
/// Stretch stiffness, N/m: the strip of N = 32 is 200 times as stiff in its plane as across.
const STIFF: f64 = 1e5;

/// The position of a strip, and the direction in which it buckles.
struct Form {
    /// Critical σgL³/B of the continuum.
    critical: f64,
    /// Properties of the fabric, except for the bending stiffness.
    fabric: Fabric,
    /// Map from the scene's positions, a vertical sheet clamped at its upper end, to those of the strip.
    lay: fn(DVec3) -> DVec3,
    /// Direction in which the strip buckles.
    sideways: DVec3,
    /// Sign of gravity: negative for a column, which stands on its clamp.
    upright: f64,
}

/// A column clamped at its foot (Greenhill 1881).
const COLUMN: Form = Form {
    critical: SELF_WEIGHT_COLUMN,
    fabric: chains(STIFF),
    lay: |x| x,
    sideways: DVec3::Z,
    upright: -1.0,
};

/// A strip on edge, with its length level (Prandtl 1899): qL³/√(EI·C) with EI = Bb and, for a sheet that does
/// not contract sideways, C = 2Bb.
const STRIP_ON_EDGE: Form = Form {
    critical: LATERAL_BUCKLING * SQRT_2,
    fabric: Fabric { stretch: [STIFF, STIFF], shear: 0.1 * STIFF, ..Fabric::STANDARD },
    lay: |x| dvec3(0.0, x.x, -x.y),
    sideways: DVec3::X,
    upright: 1.0,
};

/// Cases of columns of N links, of the order at which they approach the continuum, and of strips on edge.
pub fn cases(mount: &Mount) -> Vec<Case> {
    let columns = COLUMNS.map(|segments| column(mount, segments));
    let errors = columns.each_ref().map(|case| case.measured - COLUMN.critical);
    let name = format!("Greenhill column, order in N, {}", label(YARNS));
    let mut cases = columns.to_vec();
    cases.push(order(name, 2.0, &errors[..ORDERED]));
    cases.extend(ON_EDGE.map(|segments| on_edge(mount, segments)));
    cases
}

/// The expected load is that of the discrete column.
fn column(mount: &Mount, segments: usize) -> Case {
    let masses = Grid::new(&scene(&COLUMN, segments)).masses;
    // The masses are in units of a whole row's mass.
    let row = masses[4..6].iter().sum::<f64>();
    let rows: Vec<[f64; 2]> =
        masses[4..].chunks_exact(2).map(|ends| [ends[0] / row, ends[1] / row]).collect();
    Case::new(
        format!("Greenhill column σgL³/B, N = {segments}, {}", label(YARNS)),
        column_of_links(&rows),
        critical_load(mount, &COLUMN, segments, YARNS),
        READING,
    )
}

/// The expected load is that of a strip which sags in its plane before it buckles: q₀/√((1 − EI/EI′)(1 − C/EI′)) with
/// the stiffness EI′ in its plane (Hodges and Peters 1975). Two lines of links of half the width b each have
/// EI′ = Y b³/4; EI is B b and C twice that.
fn on_edge(mount: &Mount, segments: usize) -> Case {
    let bending = Fabric::STANDARD.density * GRAVITY / STRIP_ON_EDGE.critical;
    let ratio = 4.0 * bending * (segments * segments) as f64 / STIFF;
    Case::new(
        format!("lateral buckling σgL³/B (twist), N = {segments}, {}", label(YARNS)),
        STRIP_ON_EDGE.critical / ((1.0 - ratio) * (1.0 - 2.0 * ratio)).sqrt(),
        critical_load(mount, &STRIP_ON_EDGE, segments, YARNS),
        MARGIN * WARPING / segments as f64 + READING,
    )
}

/// Whether a perturbation of a strip on edge grows under a fraction of its critical load.
pub fn on_edge_grows(mount: &Mount, segments: usize, part: f64) -> bool {
    grows(mount, &STRIP_ON_EDGE, segments, YARNS, part * STRIP_ON_EDGE.critical)
}

/// The load σgL³/B above which a perturbation of the tip grows, by bisection.
fn critical_load(mount: &Mount, form: &Form, segments: usize, settings: StepSettings) -> f64 {
    let grows = |load| grows(mount, form, segments, settings, load);
    bisect_times(HALVINGS, 0.0, 2.0 * form.critical, grows)
}

/// Whether a perturbation in the shape of the first mode grows under a load σgL³/B.
fn grows(mount: &Mount, form: &Form, segments: usize, settings: StepSettings, load: f64) -> bool {
    let scene = scene(form, segments);
    let still = vec![DVec3::ZERO; scene.vertices()];
    let gravity = form.upright * GRAVITY * load / form.critical;
    // The load settles first: under a sudden one a strip swings in its plane and carries up to twice its weight.
    let mut settling = mount(&Scene { damping: DAMPING, ..scene.clone() }, settings);
    let flat: Vec<DVec3> = scene.positions().into_iter().map(form.lay).collect();
    settling.place(&flat, &still);
    settling.load(gravity);
    run(settling.as_mut(), SETTLING);
    let perturbed: Vec<DVec3> = settling
        .positions()
        .iter()
        .zip(scene.positions())
        .map(|(settled, rest)| {
            let along = (-rest.y - 1.0 / segments as f64).max(0.0);
            let bent = 1.0 - (FRAC_PI_2 * along).cos();
            settled.as_dvec3() + form.sideways * (PERTURBATION * bent)
        })
        .collect();
    let mut specimen = mount(&scene, settings);
    specimen.place(&perturbed, &still);
    specimen.load(gravity);
    (0..ticks(SECONDS)).any(|_| {
        specimen.tick();
        let tip = row(&scene, specimen.as_ref(), segments + 1).dot(form.sideways).abs();
        // A tip that is not a number has grown, too.
        tip.is_nan() || tip >= GROWN * PERTURBATION
    })
}

/// Scene of a strip at standard gravity: one metre is free, and one more cell lies in the clamp.
fn scene(form: &Form, segments: usize) -> Scene {
    let bending = Fabric::STANDARD.density * GRAVITY / form.critical;
    let length = 1.0 + 1.0 / segments as f64;
    let fabric = Fabric { bending, ..form.fabric };
    strip(segments + 1, length, Pins::TopClamp, Pose::Vertical, fabric)
}
