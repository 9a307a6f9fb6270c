//! Free meshes at rest, without loads and damping: any motion is energy gained by an error.

use std::f32::consts::TAU;
use std::sync::Arc;

use bunting_solver::{
    ClothBatch, ClothSnapshot, Drive, Fabric, FabricBuilder, FabricMaterial, LaneCount,
    StepSettings,
};
use glam::Vec3;

use super::{AT_REST, advance, fastest};
use crate::product::DEFAULT;
use crate::stability::case::HardCase;

/// Radius of the meshes, m.
const RADIUS: f32 = 0.3;

/// Bowl and ball, at the default number of substeps and at eight.
pub(super) fn cases(quick: bool) -> Vec<HardCase> {
    let seconds = if quick { 10.0 } else { 30.0 };
    let rings = if quick { 8 } else { 16 };
    let meshes =
        [("bowl", sphere(16, 6, [0.2, 1.6])), ("ball", sphere(2 * rings, rings, [0.15, 2.99]))];
    let settings = [DEFAULT, StepSettings { substeps: 8, ..DEFAULT }];
    let cases = meshes.iter().flat_map(|mesh| settings.map(|settings| (mesh, settings)));
    cases.map(|((name, fabric), settings)| at_rest(name, fabric, seconds, settings)).collect()
}

/// The part of a sphere between two angles (rad) from its axis, of `rings` rings of `around` quads.
fn sphere(around: u32, rings: u32, [first, last]: [f32; 2]) -> Arc<Fabric> {
    let vertex = |ring: u32, at: u32| {
        let polar = first + (last - first) * ring as f32 / rings as f32;
        let azimuth = TAU * at as f32 / around as f32;
        let outwards =
            Vec3::new(polar.sin() * azimuth.cos(), polar.cos(), polar.sin() * azimuth.sin());
        RADIUS * outwards
    };
    let quads = |rings: u32| (0..rings).flat_map(move |ring| (0..around).map(move |at| (ring, at)));
    let positions = quads(rings + 1).map(|(ring, at)| vertex(ring, at)).collect();
    let triangles = quads(rings).flat_map(|(ring, at)| {
        let corner = |down: u32, right: u32| (ring + down) * around + (at + right) % around;
        let [a, b, c, d] = [corner(0, 0), corner(0, 1), corner(1, 0), corner(1, 1)];
        [a, b, c, c, b, d]
    });
    Arc::new(FabricBuilder::new(positions, triangles.collect()).build().expect("a good mesh"))
}

/// Case of a mesh at rest in eight lanes of polyester without damping: its RMS speed, with stretch
/// stiffnesses over four decades and bending stiffnesses over six.
fn at_rest(name: &str, fabric: &Arc<Fabric>, seconds: f32, settings: StepSettings) -> HardCase {
    let scaled = |stretch: f32, bend: f32| {
        let polyester = FabricMaterial::FLAG_POLYESTER;
        FabricMaterial {
            warp_stiffness: stretch * polyester.warp_stiffness,
            weft_stiffness: stretch * polyester.weft_stiffness,
            shear_stiffness: stretch * polyester.shear_stiffness,
            bend_stiffness: bend * polyester.bend_stiffness,
            damping: 0.0,
            ..polyester
        }
    };
    let stretches = [0.01, 0.1, 5.0, 50.0].map(|factor| scaled(factor, 1.0));
    let bends = [0.01, 1.0, 100.0, 1e4].map(|factor| scaled(1.0, factor));
    let mut batch = ClothBatch::new(Arc::clone(fabric), LaneCount::Eight);
    for material in stretches.into_iter().chain(bends) {
        let rest = ClothSnapshot::at_rest(fabric);
        let lane = batch.insert(&rest, material).expect("a good cloth");
        batch.drive(lane, Drive::NONE).expect("a good drive");
    }
    advance(&mut batch, seconds, settings);
    let name = format!("free {name} at rest, {} substeps", settings.substeps);
    HardCase::new(name, 0, "RMS speed, m/s", fastest(&batch), AT_REST)
}
