//! A cloth of a group.

use core::ops::Range;
use std::sync::Arc;

use glam::{Quat, Vec3};

use crate::contact::itself::place::Pose;
use crate::fabric::Fabric;
use crate::step::frame::FrameMotion;

/// A cloth that may touch the others of its group.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroupMember {
    /// Distance that the cloth keeps from others, m: two keep the mean of theirs.
    pub thickness: f32,
    /// Layers that the cloth is a member of, one a bit.
    pub memberships: u32,
    /// Layers whose members the cloth touches, one a bit. Two cloths touch if each filters a layer of the other.
    pub filters: u32,
    /// Pose of the cloth's frame in the world at the start of the tick.
    pub start: (Vec3, Quat),
    /// Motion of the frame in the tick. It may be more than the [`Drive`](crate::Drive) has.
    pub motion: FrameMotion,
    /// Velocity in the world of what the state's velocities are relative to, m/s. Zero, unless that moves along with the
    /// frame.
    pub carrier: Vec3,
}

impl GroupMember {
    /// Whether the thickness is greater than zero, and all numbers are finite.
    #[must_use]
    pub fn is_valid(&self) -> bool {
        let Self { thickness, start, motion, carrier, .. } = self;
        let vectors = [start.0, motion.translation, *carrier];
        let turns = [start.1, motion.rotation];
        *thickness > 0.0
            && thickness.is_finite()
            && vectors.iter().all(|it| it.is_finite())
            && turns.iter().all(|it| it.is_finite())
    }

    /// Whether two cloths touch.
    pub(super) fn touches(&self, other: &Self) -> bool {
        self.memberships & other.filters != 0 && other.memberships & self.filters != 0
    }

    /// Pose of the frame after a part of the tick, relative to an origin in the world, m.
    fn pose(&self, part: f32, origin: Vec3) -> Pose {
        let (translation, rotation) = self.start;
        let moved = rotation * (self.motion.translation * part);
        Pose {
            origin: (translation - origin) + moved,
            rotation: (rotation * self.motion.rotation_at(part)).normalize(),
            carrier: self.carrier,
        }
    }
}

/// A cloth of a group in a substep.
#[derive(Clone, Debug)]
pub(crate) struct Member {
    pub settings: GroupMember,
    /// Its particles among those of the group.
    pub range: Range<usize>,
    /// Distance that its own layers keep, m, if they do.
    pub own_thickness: Option<f32>,
    /// Coulomb friction coefficient.
    pub friction: f32,
    /// Its own particles that seams join, in both orders, ascending.
    pub sewn: Vec<[u32; 2]>,
    pub fabric: Arc<Fabric>,
    /// Whether the cloth moves in this substep. One that does not is held.
    pub moves: bool,
    /// Whether its positions and settings are finite. It touches nothing if they are not.
    pub is_finite: bool,
    pub(super) pose: Pose,
}

impl Member {
    /// The particles that seams join, among those of the group.
    pub fn sewn_of_group(&self) -> impl Iterator<Item = [u32; 2]> {
        let first = self.range.start as u32;
        self.sewn.iter().map(move |pair| pair.map(|particle| particle + first))
    }

    /// Sets the pose after a part of the tick.
    pub fn set_pose(&mut self, part: f32, origin: Vec3) {
        self.pose = self.settings.pose(part, origin);
    }
}
