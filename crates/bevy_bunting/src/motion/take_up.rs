//! Newly attached vertices that are not in their places yet: they are moved there within a second.

use bevy_math::{Isometry3d, Vec3};
use bunting_solver::{ClothSnapshot, Fabric};

/// Time in which newly attached vertices move to their places, s. In half of it they would move twice as
/// fast, and cloth at a distance of [`REACH`] would be stretched by a tenth.
const TIME: f32 = 1.0;

/// Greatest distance over which the vertices are moved, m: a cloth farther away is first put in place as a
/// whole, as by a teleport.
const REACH: f32 = 2.0;

/// Attached vertices on the way to their places.
#[derive(Clone, Debug)]
pub(crate) struct TakingUp {
    /// Indices of the pinned particles, and their positions when the motion began, m.
    from: Vec<(usize, Vec3)>,
    /// Time since the motion began, s.
    passed: f32,
}

impl TakingUp {
    /// Transforms a kept state into the new frame by `change`, with its pins left where they are, and begins
    /// their motion. None if all pins are in their places.
    pub fn begin(
        snapshot: &mut ClothSnapshot,
        fabric: &Fabric,
        change: Isometry3d,
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
        pins.iter().for_each(|&pin| snapshot.velocities[pin] = Vec3::ZERO);
        let from: Vec<_> = pins.iter().map(|&pin| (pin, snapshot.positions[pin])).collect();
        from.iter().any(|&(pin, at)| at != rest[pin]).then_some(Self { from, passed: 0.0 })
    }

    /// Moves the pins for `tick` seconds. Returns whether all are in their places.
    pub fn go_on(&mut self, tick: f32, fabric: &Fabric, positions: &mut [Vec3]) -> bool {
        self.passed += tick;
        let part = (self.passed / TIME).min(1.0);
        let eased = part * part * (3.0 - 2.0 * part);
        for &(pin, from) in &self.from {
            let rest = fabric.rest_positions()[pin];
            positions[pin] = if part < 1.0 { from.lerp(rest, eased) } else { rest };
        }
        part == 1.0
    }
}
