//! A cape on a running figure of capsules.

use std::{f32::consts::TAU, sync::Arc};

use bunting_solver::{
    ClothSnapshot, Collider, Drive, FabricBuilder, FabricMaterial, FrameMotion, Grid,
};
use glam::{Quat, Vec3};
use parry3d::shape::SharedShape;

use super::{
    super::{
        rig::{GRAVITY, Trial},
        row::Row,
    },
    layers::LAYERS,
    watch::Watch,
};
use crate::product::TICK;

/// Steps of both legs in a second.
const RATE: f32 = 1.4;
/// Speed of the run, m/s.
const SPEED: f32 = 4.0;

/// Row of the part of ticks in which the cape intersects itself.
pub(super) fn row(quick: bool) -> Row {
    let (watch, us) = worn(Some(LAYERS), if quick { 10.0 } else { 30.0 });
    watch.row_of_ticks("cape of 600 particles on a runner", us)
}

/// Runs for some seconds along −z, with the shoulders at the origin of the cape's frame; returns the mean time of a tick,
/// too, µs.
fn worn(layers: Option<f32>, seconds: f32) -> (Watch, f64) {
    let grid = FabricBuilder::grid(Grid::new(20, 30, 0.6, 1.0));
    let fabric = Arc::new(grid.pin_where(|_, uv| uv.y == 0.0).build().expect("a good grid"));
    let mut start = ClothSnapshot::at_rest(&fabric);
    for (particle, at) in start.positions.iter_mut().enumerate() {
        at.x -= 0.3;
        // Behind the back, and further off below.
        at.z += 0.16 - 0.3 * at.y;
        at.y *= (1.0_f32 - 0.3 * 0.3).sqrt();
        if !fabric.is_pinned(particle) {
            at.z += 1e-3 * ((particle * 7919 % 1000) as f32 / 1000.0 - 0.5);
        }
    }
    let material = FabricMaterial { surface_friction: 0.3, ..FabricMaterial::COTTON };
    let mut cloth = Trial::from(&fabric, &start, material, -GRAVITY * Vec3::Y);
    cloth.keep_layers_apart(layers);
    let mut watch = Watch::default();
    for tick in 0..(seconds / TICK) as usize {
        let [from, to] = [tick, tick + 1].map(|tick| tick as f32 * TICK);
        let motion = FrameMotion::between(shoulders(from), shoulders(to));
        let wind = SPEED * Vec3::new(0.2 * (TAU * 0.3 * from).sin(), 0.0, 1.0);
        cloth.drive(Drive { motion, wind, ..Drive::default() });
        let body = body(from).into_iter().zip(body(to)).map(|((shape, from), (_, to))| Collider {
            from,
            to,
            friction: 0.3,
            ..Collider::fixed(shape, Vec3::ZERO, Quat::IDENTITY)
        });
        cloth.touch(body);
        cloth.tick();
        watch.note(&cloth);
    }
    (watch, cloth.us())
}

/// Pose of the shoulders in a frame that moves along with the runner: they rise and fall with each step and turn a little.
fn shoulders(time: f32) -> (Vec3, Quat) {
    let phase = TAU * RATE * time;
    (0.04 * (2.0 * phase).sin() * Vec3::Y, Quat::from_rotation_y(0.25 * phase.sin()))
}

/// Torso, thighs and shins, each with its pose in the cape's frame.
fn body(time: f32) -> [(SharedShape, (Vec3, Quat)); 5] {
    let phase = TAU * RATE * time;
    let torso = (SharedShape::capsule_y(0.25, 0.14), (-0.3 * Vec3::Y, Quat::IDENTITY));
    let leg = |side: f32| {
        // The legs are half a period apart.
        let swing = 0.7 * side.signum() * phase.sin();
        let knee = 0.5 + 0.5 * side.signum() * phase.cos();
        let hip = Vec3::new(side, -0.6, 0.0);
        let thigh = Quat::from_rotation_x(-swing);
        let shin = Quat::from_rotation_x(-swing - knee);
        let middle = hip + thigh * (-0.22 * Vec3::Y);
        let foot = hip + thigh * (-0.44 * Vec3::Y) + shin * (-0.22 * Vec3::Y);
        [
            (SharedShape::capsule_y(0.2, 0.08), (middle, thigh)),
            (SharedShape::capsule_y(0.2, 0.06), (foot, shin)),
        ]
    };
    let ([left_thigh, left_shin], [right_thigh, right_shin]) = (leg(-0.1), leg(0.1));
    [torso, left_thigh, left_shin, right_thigh, right_shin]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn passes_through_itself_unless_its_layers_are_kept_apart() {
        assert!(worn(None, 2.0).0.most > 0);
    }
}
