//! Inertia: how much of the frame's acceleration a cloth feels.
//!
//! The cloth is simulated in a carrier, in which velocities are measured and which counts as at rest. For a cloth that feels
//! everything it is the world. Otherwise it moves with the frame's origin, and the part of the origin's acceleration that
//! is felt acts like gravity; and it turns with the part of the frame's turn that is not felt.

use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bunting_solver::{ClothSnapshot, Drive, FrameMotion};

/// The parts of its frame's acceleration that a cloth feels, from 0 to 1, so that the cape of a hero who dashes and spins
/// stays a cape. Without this component, and by default, cloth feels everything, as in nature. The wind of a steady ride is
/// felt in any case.
///
/// Where a part is less than 1, [`ClothControl`](crate::ClothControl) and [`ClothParticles`](crate::ClothParticles) give
/// velocities relative to the motion that is not felt. A part outside of 0 to 1 is reported as [`ClothError::Inertia`](crate::ClothError::Inertia), and
/// the cloth feels everything.
///
/// ```
/// use bevy_bunting::prelude::*;
///
/// // The cape of a hero who dashes stays a cape.
/// let cape = (ClothMesh::grid(17, 33, 0.8, 1.2), ClothInertia { linear: 0.3, angular: 0.5 });
/// # assert_eq!(ClothInertia::default(), ClothInertia { linear: 1.0, angular: 1.0 });
/// ```
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
pub struct ClothInertia {
    /// The part of the acceleration of the frame's origin.
    pub linear: f32,
    /// The part of the frame's turn: of the angular velocity from which centrifugal forces follow, and of its change.
    pub angular: f32,
}

impl Default for ClothInertia {
    fn default() -> Self {
        Self { linear: 1.0, angular: 1.0 }
    }
}

impl ClothInertia {
    /// Parts of the linear and of the angular acceleration.
    #[must_use]
    pub const fn new(linear: f32, angular: f32) -> Self {
        Self { linear, angular }
    }

    /// Whether both parts are from 0 to 1.
    pub(super) fn is_valid(self) -> bool {
        [self.linear, self.angular].iter().all(|part| (0.0..=1.0).contains(part))
    }

    /// The parts that act.
    pub(crate) fn acting(self) -> Self {
        if self.is_valid() { self } else { Self::default() }
    }

    /// Whether the cloth feels everything.
    pub(crate) fn is_full(self) -> bool {
        self == Self::default()
    }

    /// The greater of the two parts.
    pub(crate) fn greatest(self) -> f32 {
        self.linear.max(self.angular)
    }

    /// Reduces what a cloth that does not feel everything feels in a tick of `tick` seconds, given the motion of its frame in the tick before.
    pub(crate) fn reduce(self, drive: &mut Drive, before: &FrameMotion, tick: f32) {
        let motion = drive.motion;
        let velocity = ride(&motion, tick);
        let earlier = motion.rotation.inverse() * ride(before, tick);
        drive.gravity -= (velocity - earlier) * (self.linear / tick);
        drive.wind -= velocity;
        drive.motion.translation = Vec3::ZERO;
        if self.angular < 1.0 {
            drive.motion.rotation = motion.rotation_at(self.angular);
        }
    }

    /// Velocity of the carrier (m/s) at a point in the frame (m).
    pub(crate) fn carrier(self, point: Vec3, motion: &FrameMotion, tick: f32) -> Vec3 {
        if self.is_full() {
            return Vec3::ZERO;
        }
        let turn = motion.turn() * ((1.0 - self.angular) / tick);
        ride(motion, tick) + turn.cross(point)
    }

    /// Changes a state so that the cloth goes on without a jolt when these parts replace others, given the motion of the
    /// frame in a tick of `tick` seconds.
    pub(crate) fn replace(
        self,
        former: Self,
        state: &mut ClothSnapshot,
        motion: &FrameMotion,
        tick: f32,
    ) {
        for particle in 0..state.positions.len() {
            let at = state.positions[particle];
            let change = former.carrier(at, motion, tick) - self.carrier(at, motion, tick);
            state.add_velocity(particle, change);
        }
    }
}

/// Velocity of a frame's origin along its axes at the end of a tick of `tick` seconds, m/s.
pub(crate) fn ride(motion: &FrameMotion, tick: f32) -> Vec3 {
    motion.rotation.inverse() * motion.translation / tick
}
