//! A sheet that lies on a floor presses on it with its weight.

use bunting_solver::Collider;
use glam::{Quat, Vec3};
use parry3d::shape::SharedShape;

use super::{
    rig::{GRAVITY, THICKNESS, Trial, cotton, floor, sheet, substeps},
    row::Row,
};
use crate::{product::TICK, stats::worse};

/// Number by which the floor's reaction is found.
const FLOOR: u64 = 1;

pub(super) fn rows(_: bool) -> Vec<Row> {
    let mut rows: Vec<Row> = [1, 2, 4].map(at_rest).into();
    rows.extend([1, 2, 4].map(landing));
    rows
}

fn reporting(collider: Collider) -> Collider {
    Collider { reports_as: Some(FLOOR), ..collider }
}

/// Impulse on the floor in the last tick, N·s, and area that touches it, m².
fn reaction(cloth: &Trial) -> (Vec3, f32) {
    cloth.batch.reactions(0).next().map_or((Vec3::ZERO, 0.0), |it| (it.impulse, it.area))
}

/// Row of the force on a floor, in every tick of a second.
fn at_rest(steps: u32) -> Row {
    let material = cotton(0.5);
    let gravity = -GRAVITY * Vec3::Z;
    let mut cloth = Trial::new(&sheet(17, 17, 1.0, 1.0), material, gravity).with(substeps(steps));
    cloth.touch([reporting(floor(0.5))]);
    cloth.run(1.0);
    let weight = material.area_density * gravity;
    let mut error = 0.0;
    for _ in 0..60 {
        cloth.tick();
        let (impulse, area) = reaction(&cloth);
        error = worse(error, ((impulse / TICK).distance(weight) / weight.length()).into());
        error = worse(error, (area - 1.0).abs().into());
    }
    let name = format!("weight on a floor, {steps} substeps");
    Row::new(name, "error of force and area, of one", error, 0.01, cloth.us())
}

/// Row of the impulse on a box over two seconds in which a sheet falls on it and comes to rest: the weight for this
/// time.
fn landing(steps: u32) -> Row {
    /// s.
    const SECONDS: f32 = 2.0;
    let material = cotton(0.5);
    let gravity = -GRAVITY * Vec3::Z;
    let mut cloth = Trial::new(&sheet(17, 17, 1.0, 1.0), material, gravity).with(substeps(steps));
    let slab = SharedShape::cuboid(2.0, 2.0, 0.5);
    let at = -(0.5 + 0.2 + THICKNESS) * Vec3::Z;
    cloth.touch([reporting(Collider::fixed(slab, at, Quat::IDENTITY))]);
    let mut total = Vec3::ZERO;
    for _ in 0..(SECONDS / TICK).round() as usize {
        cloth.tick();
        total += reaction(&cloth).0;
    }
    let expected = material.area_density * gravity * SECONDS;
    let error = total.distance(expected) / expected.length();
    let name = format!("impulse of a landing, {steps} substeps");
    Row::new(name, "error, of one", error.into(), 0.02, cloth.us())
}
