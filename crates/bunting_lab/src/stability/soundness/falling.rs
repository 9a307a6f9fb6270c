//! Meshes that nothing holds and no air slows: they must fall as stones do, and keep their shape.

use std::f32::consts::TAU;
use std::sync::Arc;

use bunting_solver::{
    ClothBatch, ClothSnapshot, Drive, Fabric, FabricBuilder, FabricMaterial, LaneCount, StepLimits,
};
use glam::{DVec2, Vec3};

use super::pulled;
use super::run::{GRAVITY, advance, standard};
use crate::meshes::{Sheet, Triangulation, net};
use crate::product::TICK;
use crate::stability::case::HardCase;

/// Time for which they fall, s.
const FALLING: f32 = 0.5;
/// Greatest distance of a particle from where it falls to by itself, m. The first substep, of first order, takes 0.5 mm; a
/// hold of a hundredth of the weight would take 12 mm.
const APART: f64 = 1e-3;

/// Cases of sheets, tubes with and without holes, and trousers.
pub(super) fn cases() -> Vec<HardCase> {
    let sheet = Sheet::new(Triangulation::Delaunay, [24, 24], DVec2::ONE, 1);
    let disk = FabricBuilder::new(sheet.round(0.5), sheet.indices.clone());
    vec![
        case("sheet with a hole", [net(&sheet.with_hole(0.2))]),
        case("disk", [net(&disk)]),
        case("tubes", tubes(0.0)),
        case("tubes with a hole", tubes(0.22)),
        case("pair of trousers", [net(&pulled::trousers())]),
    ]
}

/// Tubes of various heights and numbers of vertices without texture, with a hole of a radius, in units of their girth.
fn tubes(radius: f32) -> Vec<Arc<Fabric>> {
    let mut tubes = Vec::new();
    for (triangulation, columns) in [Triangulation::Delaunay, Triangulation::Scan]
        .into_iter()
        .flat_map(|triangulation| (14..30).step_by(3).map(move |columns| (triangulation, columns)))
    {
        let holed = Sheet::new(triangulation, [columns, 24], DVec2::ONE, 1).with_hole(radius);
        let (positions, indices) = (holed.positions().to_vec(), holed.indices().to_vec());
        let sheet = Sheet { positions, indices };
        let around = sheet.bent(1.0 / TAU);
        for height in [0.7, 1.0, 1.6] {
            let corners = around.iter().map(|at| *at * Vec3::new(1.0, height, 1.0)).collect();
            let mesh = FabricBuilder::new(corners, sheet.indices.clone()).weld_distance(1e-5);
            tubes.push(net(&mesh));
        }
    }
    tubes
}

/// Case of the greatest distance of a particle of some meshes from where it falls to by itself.
fn case(name: &str, meshes: impl IntoIterator<Item = Arc<Fabric>>) -> HardCase {
    let apart = meshes.into_iter().map(apart).fold(0.0, f64::max);
    HardCase::new(format!("{name}: free fall"), 0, "greatest distance, m", apart, APART)
}

/// The greatest distance of a particle from where it falls to by itself, m; infinite if it is not a number.
fn apart(mesh: Arc<Fabric>) -> f64 {
    let settings = StepLimits::default().of_fabric(&mesh, TICK, GRAVITY);
    let mut batch = ClothBatch::new(Arc::clone(&mesh), LaneCount::One);
    let material = FabricMaterial { warp_stiffness: 1e3, weft_stiffness: 1e3, ..standard() };
    let lane = batch.insert(&ClothSnapshot::at_rest(&mesh), material).expect("a good cloth");
    let gravity = Vec3::NEG_Y * GRAVITY;
    batch.drive(lane, Drive { gravity, ..Drive::NONE }).expect("a good drive");
    advance(&mut batch, FALLING, settings);
    let fallen = 0.5 * FALLING * FALLING * gravity;
    let snapshot = batch.snapshot(lane);
    let particles = mesh.rest_positions().iter().zip(&snapshot.positions);
    let apart = particles.map(|(from, to)| f64::from((*from + fallen).distance(*to)));
    apart.map(|it| if it.is_finite() { it } else { f64::INFINITY }).fold(0.0, f64::max)
}
