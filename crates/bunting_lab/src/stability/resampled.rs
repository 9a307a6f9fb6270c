//! Garments that are simulated with particles of their own, on lines along warp and weft, and carry their meshes.
//!
//! What is simulated should be strained as its material, what is carried be as smooth as what other engines simulate.

use std::sync::Arc;

use bunting_solver::{Fabric, LinkFamily, Resampled, Resolution};
use glam::Vec3;

use super::{
    case::HardCase,
    surfaces::{OBSERVED_EVERY, State},
};
use crate::{
    meshes::clothes::Garment,
    scenes::ticks,
    simulation::in_double,
    stats::{mean, percentile},
    surface::{COMPRESSED, Observed, Surface},
};

/// Greatest figures of what is simulated: the mean size of the strain along warp and weft, %, its 99.9 %, and the parts of the links
/// that are compressed by more than 5 %, and of the triangles below .95 of their area, %.
///
/// Hung garments of 1e4 N/m are strained by .01 % by their weight. Other engines have .13 to .28 %.
struct Limits {
    mean: f64,
    tension: f64,
    compressed_links: f64,
    compressed_triangles: f64,
    /// Of the carried mesh: triangles below .8 of their area, %, and roughness, °.
    carried: [f64; 2],
}

const HUNG: Limits = Limits {
    mean: 0.06,
    tension: 3.0,
    compressed_links: 0.0,
    compressed_triangles: 0.0,
    carried: [0.0, 2.0],
};
const BLOWN: Limits = Limits {
    mean: 0.15,
    tension: 3.0,
    compressed_links: 0.1,
    compressed_triangles: 0.1,
    carried: [0.1, 3.5],
};

/// Cases of garments that hang, and fly, in cells of their own.
pub fn cases(_quick: bool) -> Vec<HardCase> {
    let states = [State::Hung, State::Blown];
    let garments = Garment::all();
    states.iter().flat_map(|state| garments.iter().flat_map(|it| of_garment(it, *state))).collect()
}

fn of_garment(garment: &Garment, state: State) -> Vec<HardCase> {
    let builder = garment.builder();
    let resolution = Resolution::Particles(builder.particle_count() as u32);
    let Resampled { fabric, carried, .. } = builder.resampled(resolution).expect("a good mesh");
    let mut simulated = Simulated::default();
    let triangles = garment.indices.as_chunks::<3>().0;
    let surface = Surface::new(&garment.positions, &garment.uv, triangles);
    let mut shown = Observed::new(surface);
    let mut cloth = state.begin(&fabric);
    let [settling, observed] = state.times();
    cloth.run(settling);
    for _ in 0..ticks(observed) / OBSERVED_EVERY {
        (0..OBSERVED_EVERY).for_each(|_| cloth.tick());
        simulated.observe(&fabric, &cloth.positions);
        shown.observe(&carried.positions(&cloth.positions));
    }
    let (name, limits) = match state {
        State::Hung => ("hung", HUNG),
        State::Blown => ("in wind", BLOWN),
    };
    let shown = shown.condition();
    simulated.strains.sort_by(f64::total_cmp);
    let sizes: Vec<f64> = simulated.strains.iter().map(|strain| strain.abs()).collect();
    // What is no number is below.
    let share = |values: &[f64], below: f64| {
        let above = values.iter().filter(|value| **value >= below).count();
        100.0 * (values.len() - above) as f64 / values.len() as f64
    };
    let case = |row: &str, figure, worst, limit| {
        let name = format!("{} in cells of its own, {name}: {row}", garment.name);
        HardCase::new(name, 0, figure, worst, limit)
    };
    vec![
        case("strain", "mean size along warp and weft, %", 100.0 * mean(&sizes), limits.mean),
        case(
            "tension",
            "99.9 % along warp and weft, %",
            100.0 * percentile(&simulated.strains, 0.999),
            limits.tension,
        ),
        case(
            "compression",
            "% of the links, by more than 5 %",
            share(&simulated.strains, -0.05),
            limits.compressed_links,
        ),
        case(
            "triangles below .95",
            "% of them, of the area at rest",
            share(&simulated.areas, COMPRESSED[1]),
            limits.compressed_triangles,
        ),
        case(
            "carried triangles below .8",
            "% of them, of the area at rest",
            shown.compressed[0],
            limits.carried[0],
        ),
        case(
            "carried roughness",
            "RMS turn of normals less that after smoothing, °",
            shown.roughness,
            limits.carried[1],
        ),
    ]
}

/// All that was seen of a fabric's links and triangles.
#[derive(Default)]
struct Simulated {
    strains: Vec<f64>,
    /// Parts of the areas at rest.
    areas: Vec<f64>,
}

impl Simulated {
    fn observe(&mut self, fabric: &Arc<Fabric>, positions: &[Vec3]) {
        let [positions, rest] = [positions, fabric.rest_positions()].map(in_double);
        for link in fabric.links().iter().filter(|link| link.family != LinkFamily::Diagonal) {
            let [a, b] = link.particles.map(|at| at as usize);
            let strain = positions[a].distance(positions[b]) / rest[a].distance(rest[b]) - 1.0;
            self.strains.push(strain);
        }
        for corners in fabric.triangles() {
            let [now, before] = [&positions, &rest].map(|of| {
                let [a, b, c] = corners.map(|at| of[at as usize]);
                (b - a).cross(c - a).length()
            });
            self.areas.push(now / before);
        }
    }
}
