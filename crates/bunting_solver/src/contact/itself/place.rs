//! Where the frame of a cloth is among those of the cloths that it touches.

use glam::{Quat, Vec3};

/// The change of coordinates between a cloth's frame and the one in which contacts are solved.
pub(in crate::contact) trait Place {
    /// Common coordinates of a point of the frame, m.
    fn to_common(&self, point: Vec3) -> Vec3;
    /// Coordinates in the frame, m.
    fn to_frame(&self, point: Vec3) -> Vec3;
    /// A velocity that the lane holds, in the common coordinates, m/s.
    fn velocity_to_common(&self, velocity: Vec3) -> Vec3;
    /// A velocity as the lane holds it, m/s.
    fn velocity_to_frame(&self, velocity: Vec3) -> Vec3;
    /// A direction along the frame's axes.
    fn direction_to_frame(&self, direction: Vec3) -> Vec3;
}

/// A cloth by itself, whose contacts are solved in its frame.
pub(in crate::contact) struct InItsFrame;

impl Place for InItsFrame {
    #[inline(always)]
    fn to_common(&self, point: Vec3) -> Vec3 {
        point
    }

    #[inline(always)]
    fn to_frame(&self, point: Vec3) -> Vec3 {
        point
    }

    #[inline(always)]
    fn velocity_to_common(&self, velocity: Vec3) -> Vec3 {
        velocity
    }

    #[inline(always)]
    fn velocity_to_frame(&self, velocity: Vec3) -> Vec3 {
        velocity
    }

    #[inline(always)]
    fn direction_to_frame(&self, direction: Vec3) -> Vec3 {
        direction
    }
}

/// The pose of a frame.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::contact) struct Pose {
    /// The frame's origin, m.
    pub origin: Vec3,
    pub rotation: Quat,
    /// Velocity of what the lane's velocities are relative to, m/s.
    pub carrier: Vec3,
}

impl Place for Pose {
    fn to_common(&self, point: Vec3) -> Vec3 {
        self.origin + self.rotation * point
    }

    fn to_frame(&self, point: Vec3) -> Vec3 {
        self.rotation.inverse() * (point - self.origin)
    }

    fn velocity_to_common(&self, velocity: Vec3) -> Vec3 {
        self.carrier + self.rotation * velocity
    }

    fn velocity_to_frame(&self, velocity: Vec3) -> Vec3 {
        self.rotation.inverse() * (velocity - self.carrier)
    }

    fn direction_to_frame(&self, direction: Vec3) -> Vec3 {
        self.rotation.inverse() * direction
    }
}
