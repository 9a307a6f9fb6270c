//! State that the choice of levels keeps for each cloth from tick to tick.

use std::sync::Arc;

use bevy_ecs::change_detection::Tick;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;

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
        // The last one is that of a cloth that is held still.
        let level = |level: u32| level.min(levels.count() as u32);
        let candidate = saved.candidate.map(|it| Candidate {
            table: table as u32,
            level: level(it.level),
            ..it
        });
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
