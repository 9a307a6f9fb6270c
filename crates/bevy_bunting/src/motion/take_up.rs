//! Vertices that are attached while they are elsewhere: they are led to their places.

use bevy_math::{Isometry3d, Vec3};
use bunting_solver::{ClothSnapshot, Fabric};

/// Time in which vertices go to where they are attached, s. In half of it they go twice as fast, and cloth
/// at a distance of [`REACH`] is stretched by a tenth.
const TIME: f32 = 1.0;

/// Greatest distance from which they are led there, m: from farther away the whole cloth is first put in
/// place, as by a teleport.
const REACH: f32 = 2.0;

/// Attached vertices on the way to their places.
#[derive(Clone, Debug)]
pub(crate) struct TakingUp {
    /// The pinned particles, and where they began, m.
    from: Vec<(usize, Vec3)>,
    /// s.
    passed: f32,
}

impl TakingUp {
    /// Of a state that was kept, given in a frame that `change` takes to the new one. The state is carried there;
    /// its pins are left where they are.
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

    /// Goes on for so many seconds; whether all are in their places.
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
