//! Inertia: how much of the frame's acceleration a cloth feels.
//!
//! The cloth is simulated in a carrier, in which velocities are measured and which counts as at rest. For a cloth that feels
//! everything it is the world. Otherwise it moves with the frame's origin, and the part of the origin's acceleration that
//! is felt acts like gravity; and it turns with the part of the frame's turn that is not felt. A limit makes what is not
//! felt greater while the frame moves faster.

use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bunting_solver::{ClothSnapshot, Drive, Fabric, FrameMotion, Loads};

/// The parts of its frame's acceleration that a cloth feels, from 0 to 1, so that the cape of a hero who dashes and spins
/// stays a cape. Without this component, and by default, cloth feels everything, as in nature. The wind of a steady ride is
/// felt in any case.
///
/// Where a part is less than 1, [`ClothControl`](crate::ClothControl) and [`ClothParticles`](crate::ClothParticles) give
/// velocities relative to the motion that is not felt. A part outside of 0 to 1, or a negative limit, is reported as
/// [`ClothError::Inertia`](crate::ClothError::Inertia), and the cloth feels everything.
///
/// ```
/// use bevy_bunting::prelude::*;
///
/// // The cape of a hero who dashes stays a cape, and hangs at 30 m/s as it does at 4 m/s.
/// let inertia = ClothInertia { max_speed: 4.0, ..ClothInertia::new(0.3, 0.5) };
/// let cape = (ClothMesh::grid(17, 33, 0.8, 1.2), inertia);
/// # assert_eq!(ClothInertia::default(), ClothInertia::new(1.0, 1.0));
/// ```
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct ClothInertia {
    /// The part of the acceleration of the frame's origin.
    pub linear: f32,
    /// The part of the frame's turn: of the angular velocity from which centrifugal forces follow, and of its change.
    pub angular: f32,
    /// Greatest speed of the frame's origin that is felt, m/s: the cloth does not feel what the frame is faster, neither when
    /// it changes nor as wind. Infinite by default.
    pub max_speed: f32,
    /// Greatest acceleration of the frame's origin that is felt, m/s². Infinite by default.
    pub max_acceleration: f32,
    /// Greatest angular velocity of the frame that is felt, rad/s. Infinite by default.
    pub max_turn_rate: f32,
}

impl Default for ClothInertia {
    fn default() -> Self {
        Self::new(1.0, 1.0)
    }
}

impl ClothInertia {
    /// Parts of the linear and of the angular acceleration, without limits.
    #[must_use]
    pub const fn new(linear: f32, angular: f32) -> Self {
        let none = f32::INFINITY;
        Self { linear, angular, max_speed: none, max_acceleration: none, max_turn_rate: none }
    }

    /// Whether both parts are from 0 to 1, and no limit is negative.
    pub(super) fn is_valid(self) -> bool {
        [self.linear, self.angular].iter().all(|part| (0.0..=1.0).contains(part))
            && [self.max_speed, self.max_acceleration, self.max_turn_rate]
                .iter()
                .all(|limit| *limit >= 0.0)
    }

    /// The parts that act.
    pub(crate) fn acting(self) -> Self {
        if self.is_valid() { self } else { Self::default() }
    }

    /// Whether the cloth feels everything.
    pub(crate) fn is_full(self) -> bool {
        self == Self::default()
    }

    /// Load of the frame's acceleration on a cloth of a fabric, m/s², as far as it is felt, given the motions of the frame
    /// in the last tick and in this one, of `tick` seconds.
    pub(crate) fn load(
        self,
        before: &FrameMotion,
        now: &FrameMotion,
        fabric: &Fabric,
        tick: f32,
    ) -> f32 {
        if self.is_full() {
            return Loads::of_frame(before, now, fabric, tick);
        }
        let limited = |motion: &FrameMotion| FrameMotion {
            rotation: motion.rotation_at(self.felt_part(1.0, motion, tick)),
            translation: motion.translation.clamp_length_max(self.max_speed * tick),
        };
        let turning = |motion: FrameMotion| FrameMotion { translation: Vec3::ZERO, ..motion };
        let [before, now] = [before, now].map(limited);
        let of_turn = Loads::of_frame(&turning(before), &turning(now), fabric, tick);
        let of_origin = Loads::of_frame(&before, &now, fabric, tick) - of_turn;
        let part = self.linear.max(self.angular);
        (part * of_origin).min(self.max_acceleration) + part * of_turn
    }

    /// The part of the frame's turn in a tick of `tick` seconds that is felt, given that which would be without a limit.
    fn felt_part(self, part: f32, motion: &FrameMotion, tick: f32) -> f32 {
        if self.max_turn_rate == f32::INFINITY {
            return part;
        }
        let turn = motion.turn().length();
        if part * turn > self.max_turn_rate * tick {
            self.max_turn_rate * tick / turn
        } else {
            part
        }
    }

    /// Reduces what a cloth that does not feel everything feels in a tick of `tick` seconds, given the motion of its frame
    /// in the tick before.
    pub(crate) fn reduce(self, drive: &mut Drive, before: &FrameMotion, tick: f32) {
        let motion = drive.motion;
        let felt = |motion: &FrameMotion| ride(motion, tick).clamp_length_max(self.max_speed);
        let velocity = felt(&motion);
        let earlier = motion.rotation.inverse() * felt(before);
        let acceleration = (velocity - earlier) * (self.linear / tick);
        drive.gravity -= acceleration.clamp_length_max(self.max_acceleration);
        drive.wind -= velocity;
        drive.motion.translation = Vec3::ZERO;
        let part = self.felt_part(self.angular, &motion, tick);
        if part < 1.0 {
            drive.motion.rotation = motion.rotation_at(part);
        }
    }

    /// The part of a sudden change of the frame's velocity (m/s) in a tick of `tick` seconds that is felt.
    pub(crate) fn felt_launch(self, velocity: Vec3, tick: f32) -> Vec3 {
        let felt = self.linear * velocity.clamp_length_max(self.max_speed);
        felt.clamp_length_max(self.max_acceleration * tick)
    }

    /// Velocity of the carrier (m/s) at a point in the frame (m).
    pub(crate) fn carrier(self, point: Vec3, motion: &FrameMotion, tick: f32) -> Vec3 {
        if self.is_full() {
            return Vec3::ZERO;
        }
        let part = self.felt_part(self.angular, motion, tick);
        let turn = motion.turn() * ((1.0 - part) / tick);
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
