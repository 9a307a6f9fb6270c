//! Cloth that begins inside a shape, as where it is spawned or teleported over one, must come out.

use bunting_solver::Collider;
use glam::{Quat, Vec3};
use parry3d::{math::Pose, shape::SharedShape};

use super::{
    rig::{GRAVITY, Trial, cotton, sheet, substeps},
    row::Row,
};
use crate::{product::TICK, stats::worse};

/// Greatest depth of a particle, m.
const DEPTH: f64 = 1e-3;

/// s.
const SECONDS: f32 = 1.0;

pub(super) fn rows(_: bool) -> Vec<Row> {
    let shapes = [
        ("ball", SharedShape::ball(0.15)),
        ("capsule", SharedShape::capsule_y(0.3, 0.12)),
        ("box", SharedShape::cuboid(0.3, 0.1, 0.15)),
        ("cylinder", SharedShape::cylinder(0.3, 0.12)),
    ];
    shapes.into_iter().flat_map(|(name, shape)| [1, 2, 4].map(|n| row(name, &shape, n))).collect()
}

/// Row of a level sheet of a metre, through which the middle of a tilted shape lies.
fn row(name: &str, shape: &SharedShape, steps: u32) -> Row {
    let gravity = -GRAVITY * Vec3::Z;
    let fabric = sheet(17, 17, 1.0, 1.0);
    let mut cloth = Trial::new(&fabric, cotton(0.4), gravity).with(substeps(steps));
    let tilted = Quat::from_rotation_x(0.6) * Quat::from_rotation_z(0.4);
    let middle = Vec3::new(0.48, -0.53, 0.0);
    cloth.touch([Collider::fixed(shape.clone(), middle, tilted)]);
    cloth.run(SECONDS);
    let mut deepest = 0.0;
    let pose = Pose::from_parts(middle, tilted);
    for _ in 0..(0.2 / TICK) as usize {
        cloth.tick();
        for at in cloth.positions() {
            let inside = -shape.distance_to_point(&pose, at, false);
            deepest = worse(deepest, inside.max(0.0).into());
        }
    }
    let name = format!("sheet that begins in a {name}, {steps} substeps");
    Row::new(name, "deepest particle after 1 s, m", deepest, DEPTH, cloth.us())
}
