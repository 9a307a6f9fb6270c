//! State that the choice of levels and the sleep at rest keep for each cloth from tick to tick.

use std::sync::Arc;

use bevy_ecs::change_detection::Tick;
use bevy_ecs::prelude::*;
use bevy_math::{Isometry3d, Vec3};

use crate::cloth::activity::ClothActivity;
use crate::fabric::levels::ClothLevels;
use crate::lod::candidate::Candidate;

/// State that the choice of levels keeps for a cloth.
#[derive(Component, Clone, Debug, Default)]
pub(crate) struct LodRecord {
    /// Address of the cloth's levels, for comparison only.
    levels: usize,
    /// The cloth as the governor last saw it; none for a cloth that is not simulated.
    pub candidate: Option<Candidate>,
    /// The activity when the cloth was last examined.
    pub activity: ClothActivity,
    /// Position of the middle particle at that time, in the cloth's frame, m.
    pub middle: Vec3,
    /// The same position in the world, m.
    pub centre: Vec3,
    /// Change of the cloth's pose for which `centre` was computed.
    pub placed: Tick,
    /// Greatest distance of any particle from the middle one in the frame, m times the size of cloth that has grown.
    pub radius: f32,
    /// Number that decides in which ticks the cloth is examined.
    pub phase: u32,
    /// Tick of the last change of level.
    pub changed: u32,
    /// Last tick in which the cloth was on or near a screen.
    pub seen: u32,
    /// Whether the cloth has fewer levels than it asks for.
    pub has_fewer_levels: bool,
}

impl LodRecord {
    /// The record of a cloth with new levels.
    pub fn new(levels: &Arc<ClothLevels>, radius: f32, phase: u32, now: u32) -> Self {
        let has_fewer_levels = levels.has_fewer();
        let levels = Arc::as_ptr(levels).addr();
        Self { has_fewer_levels, levels, radius, phase, changed: now, seen: now, ..Self::default() }
    }

    /// The record of a cloth with these levels and a radius, m, of which a saved record is known in tick `now`. `table` is
    /// the index of its level table.
    pub fn restored(
        levels: &Arc<ClothLevels>,
        (table, radius): (usize, f32),
        saved: &SavedRecord,
        now: u32,
    ) -> Self {
        let candidate = saved.candidate.map(|it| Candidate { table: table as u32, ..it });
        Self {
            candidate,
            activity: saved.activity,
            middle: saved.middle,
            centre: saved.centre,
            changed: now.wrapping_sub(saved.since_change),
            seen: now.wrapping_sub(saved.since_seen),
            ..Self::new(levels, radius, saved.turn.wrapping_sub(now), now)
        }
    }

    /// What of the record outlives the cloth in tick `now`; none if the cloth has not been examined with these levels.
    pub fn saved(&self, levels: &Arc<ClothLevels>, now: u32) -> Option<SavedRecord> {
        self.is_of(levels).then(|| SavedRecord {
            candidate: self.candidate,
            activity: self.activity,
            middle: self.middle,
            centre: self.centre,
            turn: self.phase.wrapping_add(now),
            since_change: now.wrapping_sub(self.changed),
            since_seen: now.wrapping_sub(self.seen),
        })
    }

    /// The cloth has no levels any more.
    pub fn forget_levels(&mut self) {
        (self.levels, self.has_fewer_levels) = (0, false);
    }

    /// Whether the record belongs to a cloth with these levels.
    pub fn is_of(&self, levels: &Arc<ClothLevels>) -> bool {
        self.levels == Arc::as_ptr(levels).addr()
    }
}

/// A record of a saved cloth: ticks are counted back from that in which it was saved.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct SavedRecord {
    candidate: Option<Candidate>,
    activity: ClothActivity,
    middle: Vec3,
    centre: Vec3,
    turn: u32,
    since_change: u32,
    since_seen: u32,
}

/// State that the sleep at rest keeps for a cloth.
#[derive(Component, Clone, Copy, Debug, Default)]
pub(crate) struct RestTimer {
    /// Number of ticks for which the cloth has been at rest.
    pub ticks: u32,
    /// First of the cloths that the cloth may touch in this tick, which come to rest together; none without them.
    pub group: Option<Entity>,
    /// Pose of the frame at the end of the last tick.
    pub pose: Option<Isometry3d>,
    /// Distance by which the frame may be elsewhere since the world was moved, m.
    pub rounding: f32,
}

/// Part of the coordinates by which the frame of a cloth that rests may be elsewhere after the world was moved. Smaller:
/// cloth that is the child of another entity wakes. Larger: a frame that is moved by less does not wake it.
const ROUNDING: f32 = 4.0 * f32::EPSILON;

impl RestTimer {
    /// Moves the pose along with the world, m.
    pub fn shift(&mut self, by: Vec3) {
        let Some(pose) = &mut self.pose else { return };
        let before = Vec3::from(pose.translation);
        let now = before + by;
        self.rounding = self.rounding.max(ROUNDING * before.abs().max(now.abs()).max_element());
        pose.translation = now.into();
    }

    /// Whether the frame of a cloth has moved to a pose, but for rounding in a world that was moved.
    pub fn has_moved_to(&mut self, pose: Isometry3d) -> bool {
        let rounding = core::mem::take(&mut self.rounding);
        let is_near = |it: Isometry3d| {
            it.rotation.angle_between(pose.rotation) <= ROUNDING
                && it.translation.distance(pose.translation) <= rounding
        };
        if rounding > 0.0 && self.pose.is_some_and(is_near) {
            self.pose = Some(pose);
        }
        self.pose != Some(pose)
    }
}
