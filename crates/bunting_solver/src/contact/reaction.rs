//! What a cloth does to a collider in a tick.

use glam::{Quat, Vec3};

use crate::contact::collider::Collider;

/// The sum of a cloth's contacts with one collider over a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactReaction {
    /// The collider's [`reports_as`](crate::Collider::reports_as).
    pub collider: u64,
    /// Impulse on the collider, N·s, along the axes of the cloth's frame at the end of the tick.
    pub impulse: Vec3,
    /// Angular impulse on the collider about its position, N·m·s, along the same axes.
    pub angular_impulse: Vec3,
    /// Area of the cloth that touches the collider at the end of the tick, m².
    pub area: f32,
}

/// The contacts with a collider so far in a tick, in the collider's frame, which may turn.
#[derive(Clone, Debug, Default)]
pub(crate) struct ReactionSum {
    /// N·s.
    impulse: Vec3,
    /// N·m·s.
    angular_impulse: Vec3,
    /// Particles that touch the collider in the present substep; some of them more than once.
    touching: Vec<u32>,
}

impl ReactionSum {
    /// Forgets all contacts: a tick begins.
    pub fn begin_tick(&mut self) {
        (self.impulse, self.angular_impulse) = (Vec3::ZERO, Vec3::ZERO);
        self.touching.clear();
    }

    /// The sum of a collider, given its index, in a substep that begins, in which no particle touches it yet; none if it reports nothing.
    pub fn begin_substep<'a>(
        sums: &'a mut [Self],
        index: usize,
        collider: &Collider,
    ) -> Option<&'a mut Self> {
        let sum = sums.get_mut(index).filter(|_| collider.reports_as.is_some())?;
        sum.touching.clear();
        Some(sum)
    }

    /// Adds the impulse (N·s) that a particle gives to the collider at a point (m).
    pub fn add(&mut self, particle: usize, at: Vec3, impulse: Vec3) {
        self.impulse += impulse;
        self.angular_impulse += at.cross(impulse);
        self.touching.push(particle as u32);
    }

    /// The reaction of a collider with a given orientation at the end of the tick, and the areas of all particles, m².
    pub fn total(&self, collider: u64, rotation: Quat, areas: &[f32]) -> ContactReaction {
        let mut touching = self.touching.clone();
        touching.sort_unstable();
        touching.dedup();
        ContactReaction {
            collider,
            impulse: rotation * self.impulse,
            angular_impulse: rotation * self.angular_impulse,
            area: touching.iter().map(|&particle| areas[particle as usize]).sum(),
        }
    }
}
