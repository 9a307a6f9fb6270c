//! Settings and measurements that the hard cases share.

use bunting_solver::StepLimits;

use crate::{
    product::{Cloth, DEFAULT, Product},
    reference::grid::Grid,
    scenes::Scene,
    simulation::{Simulation, in_double},
    stats::{Strain, rms_length},
};

/// Greatest distance of a vertex of a metre of cloth held by an edge from a pin at the origin, m: its
/// diagonal and some strain.
pub const REACH: f64 = 1.6;
/// Largest 95th percentile of strain of a cloth that has recovered, %.
pub const RECOVERED: f64 = 1.0;

/// One cloth of the product on a scene, with default limits, substeps by need.
pub fn start(scene: &Scene) -> Cloth {
    start_within(scene, StepLimits::default())
}

/// One cloth of the product on a scene, with substeps by need within limits.
pub fn start_within(scene: &Scene, limits: StepLimits) -> Cloth {
    Product::lone(DEFAULT).start(scene).by_need(limits)
}

/// Strain of warp and weft.
pub fn strain(scene: &Scene, cloth: &Cloth) -> Strain {
    Strain::of(Grid::new(scene).strains(&in_double(cloth.positions())))
}

/// Root mean square speed, m/s.
pub fn speed(cloth: &Cloth) -> f64 {
    rms_length(&in_double(cloth.velocities()))
}

/// Distance of the farthest vertex from the origin, m; infinite if a position is not a number.
pub fn reach(cloth: &Cloth) -> f64 {
    let longest = |far: f64, x: &glam::Vec3| {
        if x.is_finite() { far.max(x.length().into()) } else { f64::INFINITY }
    };
    cloth.positions().iter().fold(0.0, longest)
}

/// Kinetic, gravitational and elastic energy, over the energy that the sheet would lose by falling its own
/// height.
pub fn energy(scene: &Scene, grid: &Grid, cloth: &Cloth) -> f64 {
    let [positions, velocities] = [cloth.positions(), cloth.velocities()].map(in_double);
    let mass: f64 = grid.masses.iter().sum();
    (grid.kinetic_energy(&velocities)
        + grid.gravity_energy(scene.gravity, &positions)
        + grid.elastic_energy(&positions))
        / (mass * scene.gravity * scene.height)
}
