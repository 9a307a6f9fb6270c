//! A sheet between two level edges.

use glam::{DVec3, dvec3};

use crate::{
    oracles::{
        Case,
        catenary::{Catenary, sag_of_chain},
        rig::{YARNS, chains, column_masses, label, order, row, run, strip},
        specimen::{Mount, Specimen},
    },
    scenes::{Pins, Pose, Scene},
};

/// Stiffness of a strip as good as inextensible, N/m: it strains by 4e-6.
const STIFF: f64 = 1e6;
/// Time to come to rest, s.
const SETTLING: f64 = 12.0;
/// Damping, 1/s.
const DAMPING: f64 = 3.0;
/// Relative error of the sag: its share of the strain is up to threefold, and the length of a chain
/// of 32 links is rounded 32 times.
const SAG: f64 = 5e-5;

/// The sag of chains of N links at three spans, and the order at which it nears the continuum's.
pub fn cases(mount: &Mount) -> Vec<Case> {
    let mut cases = Vec::new();
    for span in [0.5, 0.8, 0.9] {
        let mut errors = Vec::new();
        for segments in [8, 16, 32] {
            let scene = scene(segments);
            let specimen = hang(mount, &scene, span);
            let mut masses = column_masses(&scene);
            masses.pop();
            cases.push(Case::new(
                format!("catenary, S = {span} m, N = {segments}, {}, m", label(YARNS)),
                sag_of_chain(&masses, span, 1.0),
                -f64::from(specimen.positions()[segments].y),
                SAG,
            ));
            let middle = -row(&scene, specimen.as_ref(), segments / 2).y;
            errors.push(middle - Catenary::new(span, 1.0).sag);
        }
        let name = format!("catenary, S = {span} m, order in N, {}", label(YARNS));
        cases.push(order(name, 2.0, &errors));
    }
    cases
}

fn scene(segments: usize) -> Scene {
    let strip = strip(segments, 1.0, Pins::TopAndBottom, Pose::Horizontal, chains(STIFF));
    Scene { damping: DAMPING, ..strip }
}

/// The strip at rest between edges `span` apart, let go folded at its middle.
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
