//! A sheet between two level edges.

use glam::{DVec3, dvec3};

use crate::{
    oracles::{
        Case,
        catenary::{Catenary, sag_of_chain},
        rig::{YARNS, chains, column_masses, label, order, row, strip, substep},
    },
    scenes::{GRAVITY, Pins, Pose, Scene},
    simulation::run,
    specimen::{Mount, Specimen},
};

/// Stiffness of a nearly inextensible strip, N/m: it strains by 4e-6.
const STIFF: f64 = 1e6;
/// Time to come to rest, s.
const SETTLING: f64 = 12.0;
/// Damping, 1/s.
const DAMPING: f64 = 3.0;
/// Relative error of the sag by strain and rounding.
const SAG: f64 = 5e-5;
/// Number of sizes, from the first on, over which the order is observed: beyond them the step's error
/// dominates.
const ORDERED: usize = 3;

/// Cases of the sag of chains of N links at three spans, and of the order at which it approaches the
/// continuum.
pub fn cases(mount: &Mount) -> Vec<Case> {
    let mut cases = Vec::new();
    for span in [0.5, 0.8, 0.9] {
        let mut errors = Vec::new();
        for segments in [4, 8, 16, 32] {
            let scene = scene(segments);
            let specimen = hang(mount, &scene, span);
            let mut masses = column_masses(&scene);
            masses.pop();
            let sag = sag_of_chain(&masses, span, 1.0);
            cases.push(Case::new(
                format!("catenary, S = {span} m, N = {segments}, {}, m", label(YARNS)),
                sag,
                -f64::from(specimen.positions()[segments].y),
                SAG + frozen() / sag,
            ));
            let middle = -row(&scene, specimen.as_ref(), segments / 2).y;
            errors.push(middle - Catenary::new(span, 1.0).sag);
        }
        let name = format!("catenary, S = {span} m, order in N, {}", label(YARNS));
        cases.push(order(name, 2.0, &errors[..ORDERED]));
    }
    cases
}

/// Distance by which gravity moves the predicted positions, at which link directions are frozen, m: g(2h/3)².
fn frozen() -> f64 {
    GRAVITY * (2.0 / 3.0 * substep(YARNS)).powi(2)
}

fn scene(segments: usize) -> Scene {
    let strip = strip(segments, 1.0, Pins::TopAndBottom, Pose::Horizontal, chains(STIFF));
    Scene { damping: DAMPING, ..strip }
}

/// The strip at rest between edges `span` metres apart, released folded at its middle.
fn hang(mount: &Mount, scene: &Scene, span: f64) -> Box<dyn Specimen> {
    let mut specimen = mount(scene, YARNS);
    let half_drop = (0.25 - 0.25 * span * span).sqrt();
    let folded: Vec<DVec3> = scene
        .positions()
        .iter()
        .map(|x| dvec3(x.x, half_drop * ((2.0 * x.z - 1.0).abs() - 1.0), span * x.z))
        .collect();
    specimen.place(&folded, &vec![DVec3::ZERO; folded.len()]);
    run(specimen.as_mut(), SETTLING);
    specimen
}
