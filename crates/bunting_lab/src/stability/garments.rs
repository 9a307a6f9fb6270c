//! Garments that hang and fly: what is simulated should be strained as its material, and the mesh that it carries be smooth.

use std::sync::Arc;

use bunting_solver::{Drive, Fabric, FabricMaterial, Resampled};
use glam::Vec3;

use super::{case::HardCase, lone::Lone};
use crate::{
    flight::almost_at_rest,
    meshes::{
        clothes::{FABRIC, Garment},
        resampled,
    },
    product::yarn_strains,
    scenes::ticks,
    stats::{mean, percentile},
    surface::{Observed, Surface},
};

/// Damping of garments that hang, 1/s.
const DAMPING: f32 = 2.0;
/// Wind in which they fly, m/s.
const WIND: Vec3 = Vec3::new(1.5, 0.5, 5.8);
/// Ticks between two observations.
const OBSERVED_EVERY: usize = 12;

/// What happens to a garment, and how it should bear it.
struct Trial {
    name: &'static str,
    material: FabricMaterial,
    wind: Vec3,
    /// Time after which what hangs is at rest, and what flies has left its state at rest, s.
    settling: f64,
    /// Time in which it is observed, s.
    observed: f64,
    limits: Limits,
}

/// Greatest figures of what is simulated: the mean size of the strain along warp and weft, %, its 99.9 %, and the parts of the links
/// that are compressed by more than 5 %, and of the triangles below .95 of their area, %.
///
/// Hung garments of 1e4 N/m are strained by .01 % by their weight. Other engines have .13 to .28 %, and 2.2 to 5 % of tension; in the
/// wind .1 to .5 %, 1.6 to 4.4 % of tension, and at most 1 % of triangles below .95 of their area.
struct Limits {
    mean: f64,
    tension: f64,
    compressed_links: f64,
    compressed_triangles: f64,
    /// Of the carried mesh: triangles below .8 of their area, %, and roughness, °. A surface all in folds of ten triangles, with
    /// slopes up to 60°, has 1.8°, of eight 3.2°, of four 17°.
    carried: [f64; 2],
}

const HUNG: Trial = Trial {
    name: "hung",
    material: FabricMaterial { damping: DAMPING, ..FABRIC },
    wind: Vec3::ZERO,
    settling: 5.0,
    observed: 1.0,
    limits: Limits {
        mean: 0.06,
        tension: 3.0,
        compressed_links: 0.0,
        compressed_triangles: 0.0,
        carried: [0.0, 2.0],
    },
};
const BLOWN: Trial = Trial {
    name: "in wind",
    material: FABRIC,
    wind: WIND,
    settling: 2.0,
    observed: 3.0,
    limits: Limits {
        mean: 0.15,
        tension: 3.0,
        compressed_links: 0.1,
        compressed_triangles: 0.1,
        carried: [0.1, 3.5],
    },
};

/// Cases of garments that hang, and fly.
pub fn cases(_quick: bool) -> Vec<HardCase> {
    let garments = Garment::all();
    let of_trial = |trial| garments.iter().flat_map(move |garment| of_garment(garment, trial));
    [&HUNG, &BLOWN].into_iter().flat_map(of_trial).collect()
}

fn of_garment(garment: &Garment, trial: &Trial) -> [HardCase; 6] {
    let Resampled { fabric, carried, .. } = resampled(&garment.builder()).expect("a good mesh");
    let mut strains = Vec::new();
    let surface = Surface::new(fabric.rest_positions(), fabric.triangles());
    let mut simulated = Observed::new(surface);
    let surface = Surface::new(&garment.positions, garment.indices.as_chunks::<3>().0);
    let mut shown = Observed::new(surface);
    let mut cloth = trial.begin(&fabric);
    for _ in 0..ticks(trial.observed) / OBSERVED_EVERY {
        (0..OBSERVED_EVERY).for_each(|_| cloth.tick());
        strains.extend(yarn_strains(&fabric, &cloth.positions));
        simulated.observe(&cloth.positions);
        shown.observe(&carried.positions(&cloth.positions));
    }
    let (simulated, shown) = (simulated.condition(), shown.condition());
    strains.sort_by(f64::total_cmp);
    let sizes: Vec<f64> = strains.iter().map(|strain| strain.abs()).collect();
    // What is no number is compressed.
    let above = strains.iter().filter(|strain| **strain >= -0.05).count();
    let compressed = 100.0 * (strains.len() - above) as f64 / strains.len() as f64;
    let case = |row: &str, figure, worst, limit| {
        let name = format!("{}, {}: {row}", garment.name, trial.name);
        HardCase::new(name, 0, figure, worst, limit)
    };
    let limits = &trial.limits;
    [
        case("strain", "mean size along warp and weft, %", 100.0 * mean(&sizes), limits.mean),
        case(
            "tension",
            "99.9 % along warp and weft, %",
            100.0 * percentile(&strains, 0.999),
            limits.tension,
        ),
        case(
            "compression",
            "% of the links, by more than 5 %",
            compressed,
            limits.compressed_links,
        ),
        case(
            "triangles below .95",
            "% of them, of the area at rest",
            simulated.compressed[1],
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

impl Trial {
    /// A garment that began at rest but for a tenth of a millimetre, when it has settled.
    fn begin(&self, fabric: &Arc<Fabric>) -> Lone {
        let drive = Drive { wind: self.wind, ..Drive::default() };
        let mut cloth = Lone::new(fabric, &almost_at_rest(fabric), self.material, drive);
        cloth.run(self.settling);
        cloth
    }
}
