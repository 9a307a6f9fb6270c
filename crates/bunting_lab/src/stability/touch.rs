//! Fast colliders, and a floor.

use bunting_solver::Collider;
use glam::{Quat, Vec3};
use parry3d::shape::SharedShape;

use super::{case::HardCase, rig::start};
use crate::{
    product::TICK,
    scenes::{Pins, Pose, Scene},
    simulation::Simulation,
    stats::worse,
};

/// Speed of the collider along z, m/s.
const SPEED: f32 = 20.0;
/// Radius of the collider's swept cross-section, m.
const RADIUS: f32 = 0.05;
/// Start of the collider, m from the cloth along z.
const START: f32 = -0.5;
/// Ticks of the collider's flight.
const TICKS: usize = 4;
/// Greatest depth of a vertex in the collider, m.
const DEPTH: f64 = 1e-3;

/// Cases of a ball, a capsule and a box's edge that pass through a loose cloth.
pub fn cases(quick: bool) -> Vec<HardCase> {
    let n = if quick { 17 } else { 65 };
    let ball = SharedShape::ball(RADIUS);
    let capsule = SharedShape::capsule_x(0.2, RADIUS);
    let edge = SharedShape::cuboid(0.2, RADIUS, RADIUS);
    let turned = Quat::from_rotation_x(std::f32::consts::FRAC_PI_4);
    [
        ("ball", ball, Quat::IDENTITY),
        ("capsule", capsule, Quat::IDENTITY),
        ("edge of a box", edge, turned),
    ]
    .into_iter()
    .flat_map(|(name, shape, turn)| shot(name, n, &shape, turn))
    .chain([dropped(17)])
    .collect()
}

/// Case of a level sheet that falls on a floor and must not bounce.
fn dropped(n: usize) -> HardCase {
    const HEIGHT: f32 = 0.3;
    let scene = Scene { pose: Pose::Vertical, pins: Pins::Free, ..Scene::hang_top(n) };
    let mut cloth = start(&scene);
    let gravity = cloth.drive.gravity.length();
    cloth.drive.gravity = -gravity * Vec3::Z;
    let floor = SharedShape::halfspace(Vec3::Z);
    cloth.touch(&[Collider::fixed(floor, -HEIGHT * Vec3::Z, Quat::IDENTITY)]);
    let impact = (2.0 * gravity * HEIGHT).sqrt();
    let mut rebound = 0.0;
    for _ in 0..60 {
        cloth.tick();
        let rising = cloth.velocities().iter().map(|velocity| velocity.z).sum::<f32>();
        rebound = worse(rebound, (rising / scene.vertices() as f32 / impact).into());
    }
    HardCase::new("drop on a floor", n, "speed of rebound over that of impact", rebound, 0.05)
}

/// Cases of a shape that flies through the middle of a free sheet, and must push the vertices in its way
/// ahead. (A sheet held by its top could not follow farther than its length: it would have to slip off.)
fn shot(name: &str, n: usize, shape: &SharedShape, turn: Quat) -> [HardCase; 2] {
    let scene = Scene { pose: Pose::Vertical, pins: Pins::Free, ..Scene::hang_top(n) };
    let mut cloth = start(&scene);
    let centre = Vec3::new(0.5, -0.5, START);
    let hit: Vec<usize> = (0..scene.vertices())
        .filter(|&vertex| {
            let from = cloth.positions()[vertex] - centre;
            from.truncate().length() < 0.5 * RADIUS
        })
        .collect();
    let at = |tick: usize| (centre + Vec3::Z * (SPEED * TICK * tick as f32), turn);
    let (mut deepest, mut behind) = (0.0, 0.0);
    for tick in 0..TICKS {
        let collider = Collider {
            from: at(tick),
            to: at(tick + 1),
            ..Collider::fixed(shape.clone(), Vec3::ZERO, turn)
        };
        cloth.touch(&[collider]);
        cloth.tick();
        let (now, turned) = at(tick + 1);
        for x in cloth.positions() {
            let local = turned.inverse() * (*x - now);
            let nearest = shape.project_local_point(local, false);
            if nearest.is_inside {
                deepest = worse(deepest, nearest.point.distance(local).into());
            }
        }
        for &vertex in &hit {
            behind = worse(behind, (now.z - cloth.positions()[vertex].z).into());
        }
    }
    [
        HardCase::new(format!("20 m/s {name}: inside"), n, "deepest, m", deepest, DEPTH),
        HardCase::new(
            format!("20 m/s {name}: behind"),
            n,
            "farthest behind its middle, m",
            behind,
            DEPTH,
        ),
    ]
}
