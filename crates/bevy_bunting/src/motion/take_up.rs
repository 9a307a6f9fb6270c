//! Newly attached vertices that are not in their places yet: they are moved there within one and a half seconds.

use bevy_math::{Isometry3d, Vec3};
use bunting_solver::{ClothSnapshot, Fabric};

/// Time in which newly attached vertices move to their places, s. In one second the corner of a flag that is turned by
/// a quarter cracks like a whip at 14 m/s, in half of it cloth at a distance of [`REACH`] is stretched by a tenth.
const TIME: f32 = 1.5;

/// Greatest distance over which the vertices are moved, m: a cloth farther away is first put in place as a
/// whole, as by a teleport.
const REACH: f32 = 2.0;

/// A pinned particle on the way to its place.
#[derive(Clone, Copy, Debug)]
struct MovingPin {
    particle: usize,
    /// Position when the motion began, m.
    from: Vec3,
}

impl MovingPin {
    /// Position after a part of [`TIME`]: a cubic that begins with a velocity (m/s) and ends at `rest` without one.
    fn at(&self, part: f32, velocity: Vec3, rest: Vec3) -> Vec3 {
        let eased = part * part * (3.0 - 2.0 * part);
        let coasting = part * (1.0 - part) * (1.0 - part) * TIME;
        self.from.lerp(rest, eased) + coasting * velocity
    }
}

/// Attached vertices on the way to their places.
#[derive(Clone, Debug)]
pub(crate) struct TakingUp {
    pins: Vec<MovingPin>,
    /// Velocity when the motion began, m/s: the mean of the pins'. With a velocity of its own, each pin would draw away
    /// from its neighbours, and stretch the edge between them.
    velocity: Vec3,
    /// Time since the motion began, s.
    passed: f32,
}

impl TakingUp {
    /// Transforms a kept state into the new frame by `change`, with its pins left where they are, and begins
    /// their motion; that of cloth that `was_free` with the mean velocity of its pins, as if it were caught. None if all pins
    /// are in their places.
    pub fn begin(
        snapshot: &mut ClothSnapshot,
        fabric: &Fabric,
        change: Isometry3d,
        was_free: bool,
    ) -> Option<Self> {
        if change != Isometry3d::IDENTITY {
            snapshot.positions.iter_mut().for_each(|at| *at = change * *at);
            snapshot.velocities.iter_mut().for_each(|speed| *speed = change.rotation * *speed);
        }
        *snapshot = core::mem::take(snapshot).without_history();
        let rest = fabric.rest_positions();
        let pins: Vec<usize> =
            (0..rest.len()).filter(|&particle| fabric.is_pinned(particle)).collect();
        let way = |at: &[Vec3], pin: usize| rest[pin] - at[pin];
        let farthest = pins.iter().map(|&pin| way(&snapshot.positions, pin).length());
        if farthest.fold(0.0, f32::max) > REACH {
            let sum: Vec3 = pins.iter().map(|&pin| way(&snapshot.positions, pin)).sum();
            let shift = sum / pins.len() as f32;
            snapshot.positions.iter_mut().for_each(|at| *at += shift);
        }
        let mut velocity = Vec3::ZERO;
        if was_free {
            let sum: Vec3 = pins.iter().map(|&pin| snapshot.velocities[pin]).sum();
            velocity = sum / pins.len().max(1) as f32;
        }
        pins.iter().for_each(|&pin| snapshot.velocities[pin] = Vec3::ZERO);
        let moving = |&particle: &usize| MovingPin { particle, from: snapshot.positions[particle] };
        let pins: Vec<MovingPin> = pins.iter().map(moving).collect();
        let in_place =
            velocity == Vec3::ZERO && pins.iter().all(|pin| pin.from == rest[pin.particle]);
        (!in_place).then_some(Self { pins, velocity, passed: 0.0 })
    }

    /// Moves the pins for `tick` seconds. Returns whether all are in their places.
    pub fn go_on(&mut self, tick: f32, fabric: &Fabric, positions: &mut [Vec3]) -> bool {
        self.passed += tick;
        let part = (self.passed / TIME).min(1.0);
        for pin in &self.pins {
            let rest = fabric.rest_positions()[pin.particle];
            positions[pin.particle] =
                if part < 1.0 { pin.at(part, self.velocity, rest) } else { rest };
        }
        part == 1.0
    }
}
