//! A cloth at random in a wind, jerked, and left to rest.

use std::{sync::Arc, time::Instant};

use bunting_solver::{ClothSnapshot, Drive, Fabric, FabricMaterial, FrameMotion, StepLimits};
use glam::Vec3;
use serde::Serialize;

use super::{
    alone::Cloth,
    held,
    meshes::{Family, mesh},
    rest::Rest,
    sag::Sag,
};
use crate::{
    meshes::{Random, resampled},
    product::TICK,
    scenes::GRAVITY,
    stats::Strain,
};

/// Time for which the wind blows, s.
const BLOWN: f32 = 3.0;
/// Time after the jerk until the cloth should rest, s.
const SETTLING: f32 = 20.0;
/// Damping in that time, 1/s.
const DAMPING: f32 = 4.0;

/// A mesh at random, and what became of a cloth of it.
#[derive(Clone, Debug, Serialize)]
pub struct Trial {
    /// Number from which all of it follows.
    pub seed: u64,
    /// What the mesh is like.
    pub family: Family,
    /// What was measured, or why the mesh is no cloth.
    pub outcome: Result<Figures, String>,
}

/// What was measured of a cloth.
#[derive(Clone, Debug, Serialize)]
pub struct Figures {
    /// Number of particles.
    pub particles: usize,
    /// Substeps and passes under its weight alone.
    pub effort: [u32; 2],
    /// Time of building, s.
    pub build: f64,
    /// Least time of a tick alone under its weight, in wind, over the particles, s.
    pub tick: f64,
    /// Strain along warp and weft in the wind.
    pub blown: Strain,
    /// Greatest stretch of a link in the wind and at the end.
    pub stretch: [f64; 2],
    /// Particles of pieces that nothing holds.
    pub unheld: usize,
    /// RMS speed at the end of what hangs, m/s.
    pub speed: f64,
    /// How far it sinks without wind, if that was asked for.
    pub sag: Option<Sag>,
    /// How fast it is without wind, if that was asked for.
    pub rest: Option<Rest>,
}

/// What is asked for besides, of the same cloth begun anew.
#[derive(Clone, Copy, Debug, Default)]
pub struct Asked {
    /// How far it sinks.
    pub sag: bool,
    /// How fast it is at rest.
    pub rest: bool,
}

/// The trial of a seed, and what is asked for besides.
pub fn of_seed(seed: u64, asked: Asked) -> Trial {
    let mut random = Random::of_seed(seed);
    let family = Family::ALL[random.below(Family::ALL.len())];
    let builder = mesh(family, &mut random);
    let start = Instant::now();
    let resampled = resampled(&builder);
    let build = start.elapsed().as_secs_f64();
    let measured = resampled.map(|it| figures(it.fabric, build, &mut random, asked));
    Trial { seed, family, outcome: measured.map_err(|error| error.to_string()) }
}

/// Time of building the mesh of a seed, s.
pub fn time_to_build(seed: u64) -> f64 {
    let mut random = Random::of_seed(seed);
    let family = Family::ALL[random.below(Family::ALL.len())];
    let builder = mesh(family, &mut random);
    let start = Instant::now();
    // Whether it is a cloth is another question.
    let _ = resampled(&builder);
    start.elapsed().as_secs_f64()
}

/// Blows at a cloth, pulls it, and lets it rest.
fn figures(fabric: Arc<Fabric>, build: f64, random: &mut Random, asked: Asked) -> Figures {
    let particles = fabric.particle_count();
    let settings = StepLimits::default().of_fabric(&fabric, TICK, GRAVITY as f32);
    let stiffness = 10_f64.powf(random.within(2.5, 5.0)) as f32;
    let material = FabricMaterial {
        warp_stiffness: stiffness,
        weft_stiffness: stiffness,
        shear_stiffness: stiffness * random.within(0.005, 0.4) as f32,
        area_density: 10_f64.powf(random.within(-1.3, -0.3)) as f32,
        ..FabricMaterial::FLAG_POLYESTER
    };
    let mut vector = |size: f32| Vec3::from([0; 3].map(|_| random.within(-1.0, 1.0) as f32)) * size;
    let (wind, jerk) = (vector(20.0), vector(0.5));
    let damped = FabricMaterial { damping: DAMPING, ..material };
    let sag = asked.sag.then(|| Sag::of(&fabric, damped, settings));
    let rest = asked.rest.then(|| Rest::of(&fabric, material));
    let mut cloth = Cloth::new(&fabric, &ClothSnapshot::at_rest(&fabric), material);
    let still = Drive::default();
    cloth.advance(BLOWN, Drive { wind, ..still });
    let tick = cloth.time_of_tick(settings) / particles as f64;
    let blown = Strain::of(cloth.strains());
    let stretch_in_wind = cloth.greatest_stretch();
    cloth.set_material(damped);
    let motion = FrameMotion { translation: jerk, ..FrameMotion::NONE };
    cloth.advance(TICK, Drive { motion, ..still });
    cloth.advance(SETTLING, still);
    Figures {
        particles,
        effort: [settings.substeps, settings.passes],
        build,
        tick,
        blown,
        stretch: [stretch_in_wind, cloth.greatest_stretch()],
        unheld: held::held(&fabric).iter().filter(|is_held| !**is_held).count(),
        speed: held::speed(&cloth.batch),
        sag,
        rest,
    }
}
