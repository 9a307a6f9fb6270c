//! Meshes that are resampled, beside the same meshes as they are.

use std::{sync::Arc, time::Instant};

use bunting_solver::{
    ClothBatch, ClothSnapshot, Drive, Fabric, FabricMaterial, LaneCount, LinkFamily, Resolution,
    StepLimits,
};
use glam::Vec3;

use super::{
    lone::Lone,
    surfaces::{CLOTH, DAMPING, WIND},
};
use crate::{
    flight::almost_at_rest,
    meshes::clothes::Garment,
    product::{TICK, rms_speed},
    scenes::ticks,
    stats::{mean, percentile},
    surface::{Observed, Surface},
};

/// Prints figures of all garments.
pub fn print(filter: &str) {
    for garment in Garment::all() {
        if !garment.name.contains(filter) {
            continue;
        }
        for way in ["today", "resampled"] {
            let begun = Instant::now();
            let (fabric, carried) = if way == "today" {
                (Arc::new(garment.builder().build().expect("a fabric")), None)
            } else {
                match garment.builder().resampled(Resolution::Particles(garment.particles())) {
                    Ok(it) => (it.fabric, Some(it.carried)),
                    Err(error) => {
                        println!("{} {way}: {error}", garment.name);
                        continue;
                    }
                }
            };
            let built = begun.elapsed().as_secs_f64() * 1e3;
            for blown in [false, true] {
                let material =
                    if blown { CLOTH } else { FabricMaterial { damping: DAMPING, ..CLOTH } };
                let drive =
                    if blown { Drive { wind: WIND, ..Drive::default() } } else { Drive::default() };
                let mut cloth = Lone::new(&fabric, &almost_at_rest(&fabric), material, drive);
                cloth.run(if blown { 2.0 } else { 5.0 });
                let shown = |particles: &[Vec3]| match &carried {
                    Some(carried) => carried.positions(particles),
                    None => fabric
                        .particle_of_vertex()
                        .iter()
                        .map(|at| particles[*at as usize])
                        .collect(),
                };
                let triangles: Vec<[u32; 3]> = garment.indices.as_chunks::<3>().0.to_vec();
                let rest: Vec<Vec3> = shown(fabric.rest_positions());
                let off = rest
                    .iter()
                    .zip(&garment.positions)
                    .map(|(a, b)| a.distance(*b))
                    .fold(0.0, f32::max);
                let mut observed =
                    Observed::new(Surface::new(&garment.positions, &garment.uv, &triangles));
                let mut strains = Vec::new();
                let mut areas = Vec::new();
                let mut speed: f64 = 0.0;
                let count = if blown { 15 } else { 5 };
                for _ in 0..count {
                    for _ in 0..12 {
                        cloth.tick();
                    }
                    observed.observe(&shown(&cloth.positions));
                    speed = speed.max(rms_speed(&cloth.batch, 0));
                    links(&fabric, &cloth.positions, &mut strains);
                    let rest = fabric.rest_positions();
                    for corners in fabric.triangles() {
                        let area = |of: &[Vec3]| {
                            let [a, b, c] = corners.map(|at| of[at as usize]);
                            (b - a).cross(c - a).length()
                        };
                        areas.push(f64::from(area(&cloth.positions) / area(rest)));
                    }
                }
                strains.sort_by(f64::total_cmp);
                let size: Vec<f64> = strains.iter().map(|it| it.abs()).collect();
                let share = |part: f64| {
                    100.0 * areas.iter().filter(|area| **area < part).count() as f64
                        / areas.len() as f64
                };
                let shown = observed.condition();
                let settings = StepLimits::default().of_fabric(&fabric, TICK, 9.81);
                let mut best = f64::INFINITY;
                for _ in 0..200 {
                    let begun = Instant::now();
                    cloth.batch.step(TICK, settings);
                    best = best.min(begun.elapsed().as_secs_f64() * 1e6);
                }
                let n = fabric.particle_count() as f64;
                println!(
                    "{:22} {way:9} {:5} n {n:5} sub {} | mean {:.3} 99.9 {:.2} 1% {:.2} <.8 {:.2} <.95 {:.2} | shown <.8 {:.2} <.95 {:.2} t {:.2} e {:.3} rough {:.2} off {:.5} | {:.2} mm/s {:.0} us {:.1} ns/node/substep built {built:.0} ms {:?}",
                    garment.name,
                    if blown { "blown" } else { "hung" },
                    settings.substeps,
                    100.0 * mean(&size),
                    100.0 * percentile(&strains, 0.999),
                    100.0 * percentile(&strains, 0.01),
                    share(0.8),
                    share(0.95),
                    shown.compressed[0],
                    shown.compressed[1],
                    shown.tension,
                    shown.strain,
                    shown.roughness,
                    off,
                    1e3 * speed,
                    best,
                    1e3 * best / n / f64::from(settings.substeps),
                    fabric.stretch_solver(),
                );
            }
        }
    }
    let _ = (ticks(1.0), LaneCount::One, std::any::type_name::<(ClothBatch, ClothSnapshot)>());
}

fn links(fabric: &Fabric, positions: &[Vec3], into: &mut Vec<f64>) {
    for link in fabric.links().iter().filter(|link| link.family != LinkFamily::Diagonal) {
        let [a, b] = link.particles.map(|at| positions[at as usize]);
        into.push(f64::from(a.distance(b) / link.rest_length) - 1.0);
    }
}
