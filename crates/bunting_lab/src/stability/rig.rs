//! What the hard cases have in common.

use bunting_solver::StepSettings;
use glam::DVec3;

use crate::{
    product::{Cloth, DEFAULT, Product},
    reference::grid::Grid,
    scenes::{Scene, ticks},
    simulation::Simulation,
    stats::{Strain, rms_length},
};

/// The product as users meet it.
pub const SETTINGS: StepSettings = DEFAULT;

/// One cloth of the product on a scene.
pub fn start(scene: &Scene) -> Cloth {
    Product::lone(SETTINGS).start(scene)
}

/// Advances by `seconds`.
pub fn run(cloth: &mut Cloth, seconds: f64) {
    (0..ticks(seconds)).for_each(|_| cloth.tick());
}

/// Positions in double precision, m.
pub fn positions(cloth: &Cloth) -> Vec<DVec3> {
    cloth.positions().iter().map(|x| x.as_dvec3()).collect()
}

/// Strain of warp and weft.
pub fn strain(scene: &Scene, cloth: &Cloth) -> Strain {
    Strain::of(Grid::new(scene).strains(&positions(cloth)))
}

/// Root mean square speed, m/s.
pub fn speed(cloth: &Cloth) -> f64 {
    rms_length(&cloth.velocities().iter().map(|v| v.as_dvec3()).collect::<Vec<_>>())
}

/// Distance of the farthest vertex from the origin, m; infinite where one is not a number.
pub fn reach(cloth: &Cloth) -> f64 {
    let longest = |far: f64, x: &glam::Vec3| {
        if x.is_finite() { far.max(x.length().into()) } else { f64::INFINITY }
    };
    cloth.positions().iter().fold(0.0, longest)
}

/// Kinetic, gravitational and elastic energy over what the sheet would lose by falling its own
/// height.
pub fn energy(scene: &Scene, grid: &Grid, cloth: &Cloth) -> f64 {
    let velocities: Vec<DVec3> = cloth.velocities().iter().map(|v| v.as_dvec3()).collect();
    let positions = positions(cloth);
    let mass: f64 = grid.masses.iter().sum();
    (grid.kinetic_energy(&velocities)
        + grid.gravity_energy(scene.gravity, &positions)
        + grid.elastic_energy(&positions))
        / (mass * scene.gravity * scene.height)
}
