//! Newly attached vertices that are not in their places yet: they are moved there within one and a half seconds.

use bevy_math::{Isometry3d, Vec3};
use bunting_solver::{ClothSnapshot, Fabric, MovingPin};

/// Time in which newly attached vertices move to their places, s. In one second the corner of a flag that is turned by
/// a quarter cracks like a whip at 14 m/s, in half of it cloth at a distance of [`REACH`] is stretched by a tenth.
const TIME: f32 = 1.5;

/// Greatest distance over which the vertices are moved, m: a cloth farther away is first put in place as a
/// whole, as by a teleport.
const REACH: f32 = 2.0;

/// The way of a pinned particle to its place.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
struct Way {
    particle: u32,
    /// Position when the motion began, m.
    from: Vec3,
    /// Position now, m.
    at: Vec3,
}

impl Way {
    fn new(particle: usize, from: Vec3) -> Self {
        Self { particle: particle as u32, from, at: from }
    }

    /// Position after a part of [`TIME`]: a cubic that begins with a velocity (m/s) and ends at `place` without one.
    fn after(&self, part: f32, velocity: Vec3, place: Vec3) -> Vec3 {
        let eased = part * part * (3.0 - 2.0 * part);
        let coasting = part * (1.0 - part) * (1.0 - part) * TIME;
        self.from.lerp(place, eased) + coasting * velocity
    }
}

/// Attached vertices on the way to their places.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct TakingUp {
    pins: Vec<Way>,
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
        let in_place =
            velocity == Vec3::ZERO && pins.iter().all(|&pin| snapshot.positions[pin] == rest[pin]);
        let ways = || pins.iter().map(|&pin| Way::new(pin, snapshot.positions[pin])).collect();
        (!in_place).then(|| Self { pins: ways(), velocity, passed: 0.0 })
    }

    /// Begins the motion of all pins of a cloth from their positions, m.
    pub fn from_positions(fabric: &Fabric, positions: &[Vec3]) -> Self {
        let pins = (0..positions.len()).filter(|&particle| fabric.is_pinned(particle));
        let pins = pins.map(|pin| Way::new(pin, positions[pin])).collect();
        Self { pins, velocity: Vec3::ZERO, passed: 0.0 }
    }

    /// The motion of those pins that are still pins of a fabric.
    pub fn of_pins(mut self, fabric: &Fabric) -> Self {
        self.pins.retain(|way| fabric.is_pinned(way.particle as usize));
        self
    }

    /// Moves the pins for `tick` seconds towards their places (m), and returns their motions.
    pub fn go_on(&mut self, tick: f32, place: impl Fn(u32) -> Vec3) -> Vec<MovingPin> {
        self.passed += tick;
        let part = (self.passed / TIME).min(1.0);
        let velocity = self.velocity;
        let moved = self.pins.iter_mut().map(|pin| {
            let (from, place) = (pin.at, place(pin.particle));
            pin.at = if part < 1.0 { pin.after(part, velocity, place) } else { place };
            MovingPin { particle: pin.particle, from, to: pin.at }
        });
        moved.collect()
    }

    /// Whether all pins are in their places.
    pub fn has_ended(&self) -> bool {
        self.passed >= TIME
    }
}
