//! The parts of Häggström's figure B.1: the times of bending, shear, stretch, air, velocities and normals in
//! a flag's tick, and the times that collision and internal damping add, at each level.
//!
//! The solver's phases can be timed from outside. The time of a part within a phase is a difference: the same
//! tick with and without the part, or with one pass more. Shear is solved once a substep whatever the
//! settings: its time is the rest of the constraints' time.

use std::sync::Arc;

use bunting_solver::{Collider, FabricMaterial, StepSettings};
use glam::{Quat, Vec3};
use parry3d::shape::SharedShape;
use serde::Serialize;

use super::phases::{self, full_batch};
use crate::{
    effort::Effort,
    fleet::Fleet,
    product::{self, DEFAULT},
    scenes::{Air, Pins, Scene},
    settings::LEVELS,
};

/// The parts of every flag's tick, in the order in which they run. Damping of all motion is one
/// multiplication within the prediction.
pub const PARTS: [&str; 9] = [
    "begin of tick",
    "prediction, damping",
    "air",
    "bending",
    "shear",
    "stretch",
    "tethers",
    "velocities",
    "normals",
];

/// Additional parts: a ball behind the flag, and internal damping of a free sheet.
pub const EXTRAS: [&str; 2] = ["collision", "internal damping"];

/// Rate of the internal damping that is timed, 1/s.
const INTERNAL_DAMPING: f32 = 1.0;

/// One part of a tick at one level.
#[derive(Clone, Debug, Serialize)]
pub struct Part {
    /// Vertices along each side.
    pub n: u32,
    /// Name, of [`PARTS`] or [`EXTRAS`].
    pub part: &'static str,
    /// Time in a tick of a full batch, µs. A difference of times within their noise may be below zero.
    pub us: f64,
    /// Time of the part divided by that of the tick without any of [`EXTRAS`].
    pub fraction: f64,
}

/// Measures all parts at all levels, with default settings.
#[must_use]
pub fn measure(effort: &Effort) -> Vec<Part> {
    LEVELS.into_iter().flat_map(|n| of_level(n, effort)).collect()
}

fn of_level(n: u32, effort: &Effort) -> Vec<Part> {
    let scene = Scene::flag(n as usize);
    let still = Scene { air: Air::VACUUM, ..scene.clone() };
    // Internal damping is for cloth without pins.
    let free = Scene { pins: Pins::Free, gravity: 0.0, ..scene.clone() };
    let untethered =
        product::pattern(&scene).tethered(false).build().expect("a scene is a good grid");
    let lanes = full_batch();
    let more_passes = |passes| StepSettings { passes: DEFAULT.passes + passes, ..DEFAULT };
    let fleet = |scene: &Scene, settings| Fleet::new(scene.clone(), lanes, settings);
    let mut fleets = [
        fleet(&scene, DEFAULT),
        fleet(&still, DEFAULT),
        Fleet::of(Arc::new(untethered), scene.clone(), lanes, DEFAULT),
        fleet(&scene, more_passes(1)),
        fleet(&scene, more_passes(2)),
        fleet(&scene, DEFAULT),
        fleet(&free, DEFAULT),
        fleet(&free, DEFAULT),
    ];
    put_on_a_ball(&mut fleets[5]);
    damp_internally(&mut fleets[7], &free);
    let [whole, still, untethered, one_more, two_more, on_a_ball, free, damped] =
        phases::time_in_turn(&mut fleets, effort);
    // Each pass solves warp and weft, and every second pass ends with a Gauss–Seidel sweep over them.
    let pass = one_more.constraints - whole.constraints;
    let sweep = two_more.constraints - one_more.constraints - pass;
    let passes = f64::from(DEFAULT.passes);
    let stretch = (passes + 1.0) * pass + (passes / 2.0).floor() * sweep;
    let tethers = whole.constraints - untethered.constraints;
    let air = whole.integrate - still.integrate;
    let times = [
        whole.begin,
        whole.integrate - air,
        air,
        whole.bending,
        whole.constraints - stretch - tethers,
        stretch,
        tethers,
        whole.velocities,
        whole.normals,
    ];
    let added = [on_a_ball.total() - whole.total(), damped.total() - free.total()];
    let part = |(part, us)| Part { n, part, us, fraction: us / whole.total() };
    let parts = PARTS.into_iter().zip(times).chain(EXTRAS.into_iter().zip(added));
    parts.map(part).collect()
}

fn damp_internally(fleet: &mut Fleet, scene: &Scene) {
    let material =
        FabricMaterial { internal_damping: INTERNAL_DAMPING, ..product::material(scene) };
    let batch = &mut fleet.batches_mut()[0];
    for lane in 0..batch.lane_count() {
        batch.set_material(lane, material).expect("a good material");
    }
}

/// Puts a ball of 0.4 m behind the middle of every flag.
fn put_on_a_ball(fleet: &mut Fleet) {
    let ball = Collider::fixed(SharedShape::ball(0.2), Vec3::new(0.5, -0.5, 0.1), Quat::IDENTITY);
    let batch = &mut fleet.batches_mut()[0];
    for lane in 0..batch.lane_count() {
        batch.set_colliders(lane, [ball.clone()]).expect("good shapes");
    }
}
