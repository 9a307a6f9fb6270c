//! Meshes at rest, free or held at a vertex, without loads and damping: any motion is energy gained by an error.

use std::sync::Arc;

use bunting_solver::{
    ClothBatch, ClothSnapshot, Drive, Fabric, FabricBuilder, FabricMaterial, LaneCount,
    StepSettings,
};

use super::run::{AT_REST, advance, fastest};
use crate::meshes::{around, net, sphere};
use crate::product::DEFAULT;
use crate::stability::case::HardCase;

/// Bowl and ball, and the bowl held at a vertex, at the default number of substeps and at eight.
pub(super) fn cases(quick: bool) -> Vec<HardCase> {
    let seconds = if quick { 10.0 } else { 30.0 };
    let held = ("bowl held at a vertex", net(&bowl().pin([0])));
    let meshes = free_meshes(quick).into_iter().chain([held]);
    let settings = [DEFAULT, StepSettings { substeps: 8, ..DEFAULT }];
    let cases = meshes.flat_map(|mesh| settings.map(|settings| (mesh.clone(), settings)));
    cases.map(|((name, fabric), settings)| at_rest(name, &fabric, seconds, settings)).collect()
}

/// Bowl and ball, with their names.
pub(super) fn free_meshes(quick: bool) -> [(&'static str, Arc<Fabric>); 2] {
    let rings = if quick { 8 } else { 16 };
    let ball = around(2 * rings, rings, sphere([0.15, 2.99]));
    [("bowl", net(&bowl())), ("ball", net(&ball))]
}

fn bowl() -> FabricBuilder {
    around(16, 6, sphere([0.2, 1.6]))
}

/// Case of a mesh at rest in eight lanes of polyester without damping: its RMS speed, with stretch
/// stiffnesses over four decades and bending stiffnesses over six.
fn at_rest(name: &str, fabric: &Arc<Fabric>, seconds: f32, settings: StepSettings) -> HardCase {
    let stretches = [0.01, 0.1, 5.0, 50.0].map(|factor| scaled(factor, 1.0));
    let bends = [0.01, 1.0, 100.0, 1e4].map(|factor| scaled(1.0, factor));
    let mut batch = ClothBatch::new(Arc::clone(fabric), LaneCount::Eight);
    for material in stretches.into_iter().chain(bends) {
        let rest = ClothSnapshot::at_rest(fabric);
        let lane = batch.insert(&rest, material).expect("a good cloth");
        batch.drive(lane, Drive::NONE).expect("a good drive");
    }
    advance(&mut batch, seconds, settings);
    let kind = if fabric.has_pins() { "" } else { "free " };
    let name = format!("{kind}{name} at rest, {} substeps", settings.substeps);
    HardCase::new(name, 0, "RMS speed, m/s", fastest(&batch), AT_REST)
}

/// Polyester without damping whose stretch and bending stiffnesses are multiplied by factors.
pub(super) fn scaled(stretch: f32, bend: f32) -> FabricMaterial {
    let polyester = FabricMaterial::FLAG_POLYESTER;
    FabricMaterial {
        warp_stiffness: stretch * polyester.warp_stiffness,
        weft_stiffness: stretch * polyester.weft_stiffness,
        shear_stiffness: stretch * polyester.shear_stiffness,
        bend_stiffness: bend * polyester.bend_stiffness,
        damping: 0.0,
        ..polyester
    }
}
