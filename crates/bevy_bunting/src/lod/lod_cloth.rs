//! A cloth as the choice of levels sees it: its position, its changes of level, and its sleep.

use bevy_ecs::prelude::*;
use bevy_ecs::query::QueryData;
use bevy_math::Vec3;

use crate::batch::batches::ClothBatches;
use crate::cloth::activity::{ClothActivity, ClothPaused};
use crate::cloth::events::ClothLevelChanged;
use crate::cloth::instance::ClothInstance;
use crate::cloth::state::ClothState;
use crate::lod::effort::ClothEffort;
use crate::lod::lod_set::LodSet;
use crate::lod::record::LodRecord;
use crate::lod::view::{Sight, Sighting, View};
use crate::motion::pose::PoseHistory;

/// Number of ticks between two examinations of a cloth. Cloths take turns.
pub(super) const EXAMINED_EVERY: u32 = 4;

/// Number of ticks after which a cloth on no screen falls asleep: two examinations. Fewer: cloth at the
/// border of the screen alternately falls asleep and wakes.
const ASLEEP_AFTER: u32 = 2 * EXAMINED_EVERY;

/// The components of a cloth that the choice of levels reads and writes.
#[derive(QueryData)]
#[query_data(mutable)]
pub(crate) struct LodCloth {
    pub entity: Entity,
    pub lods: Ref<'static, LodSet>,
    pub frame: Ref<'static, PoseHistory>,
    pub instance: &'static mut ClothInstance,
    pub state: &'static mut ClothState,
    pub effort: &'static mut ClothEffort,
    pub record: &'static mut LodRecord,
    pub paused: Has<ClothPaused>,
}

impl LodClothItem<'_, '_> {
    /// Chooses the class of effort for a tick of `tick` seconds. A change of class marks the cloth as changed.
    pub fn update_effort(&mut self, tick: f32) {
        let is_simulated = if self.instance.is_changed() {
            self.instance.activity == ClothActivity::Ticking && !self.paused
        } else {
            // The record tells the same, and lies in the cache.
            self.record.candidate.is_some() && self.record.activity == ClothActivity::Ticking
        };
        if is_simulated && self.effort.update(&self.instance, &self.frame, tick) {
            self.instance.set_changed();
        }
    }

    /// Holds the cloth still in tick `now`, or simulates it again. `level` is its level to the governor.
    pub fn set_still(&mut self, is_still: bool, level: u32, now: u32) {
        let activity = if is_still { ClothActivity::OverBudget } else { ClothActivity::Ticking };
        self.instance.activity = activity;
        self.record.activity = activity;
        self.record.changed = now;
        if let Some(candidate) = &mut self.record.candidate {
            candidate.level = level;
        }
    }

    /// Changes the level in tick `now`. A cloth on no screen becomes coarser without conserving momentum and
    /// energy, which is faster.
    pub fn change_level(
        &mut self,
        to: usize,
        on_screen: bool,
        now: u32,
        batches: &mut ClothBatches,
        commands: &mut Commands,
    ) {
        let from = self.instance.level;
        let is_unseen = !on_screen && to > from;
        if is_unseen {
            self.instance.change_level_unseen(to, batches);
        } else {
            self.instance.change_level(to, batches);
        }
        let instance = &*self.instance;
        if let Some((levels, snapshot)) = instance.levels.as_ref().zip(instance.snapshot()) {
            if is_unseen {
                self.state.restart(to, levels, &snapshot.positions);
            } else if instance.activity == ClothActivity::Ticking && !self.paused {
                self.state.change_level_in_motion(to, levels, &snapshot.positions);
            } else {
                self.state.change_level(to, levels, &snapshot.positions);
            }
        }
        self.record.changed = now;
        if let Some(candidate) = &mut self.record.candidate {
            candidate.level = to as u32;
        }
        commands.trigger(ClothLevelChanged { entity: self.entity, from, to });
    }

    /// Returns the position in the world of the middle particle, m, which is near the middle of a grid, and
    /// stores it in the record.
    pub fn update_middle(&mut self) -> Vec3 {
        let positions = self.state.positions();
        self.record.middle = positions.get(positions.len() / 2).copied().unwrap_or_default();
        self.place_middle()
    }

    /// Returns the position in the world of the middle particle when the cloth was last examined, m, and stores it in
    /// the record.
    fn place_middle(&mut self) -> Vec3 {
        let size = self.instance.growth.end();
        self.record.centre = self.frame.end() * (size * self.record.middle);
        self.record.placed = self.frame.last_changed();
        self.record.centre
    }

    /// Greatest distance of any particle from the middle one in the world, m.
    pub fn radius(&self) -> f32 {
        self.instance.growth.end() * self.record.radius
    }

    /// Whether the cloth sleeps off the screen and still is off the screen, so that it need not be examined.
    pub fn stays_off_screen(&mut self, views: &[View]) -> bool {
        self.record.activity == ClothActivity::OffScreen && {
            // Poses of many sleeping cloths are not in the cache.
            let has_moved = self.record.placed != self.frame.last_changed();
            let centre = if has_moved { self.place_middle() } else { self.record.centre };
            Sighting::of(views, centre, self.radius()).sight == Sight::OffScreen
        }
    }

    /// Sends a cloth to sleep that no viewer has seen for some time. Wakes a cloth that a viewer sees, or
    /// that rests and wants a finer level. Returns whether it wakes from off the screen.
    pub fn update_activity(&mut self, sight: Sight, wants_finer: bool, now: u32) -> bool {
        let unseen = match sight {
            Sight::OnScreen | Sight::NearScreen => None,
            Sight::OffScreen => Some(ClothActivity::OffScreen),
            Sight::OutOfRange => Some(ClothActivity::OutOfRange),
        };
        if unseen.is_none() {
            self.record.seen = now;
        }
        let old = self.instance.activity;
        let is_overdue = now.wrapping_sub(self.record.seen) > ASLEEP_AFTER;
        let new = match (old, unseen) {
            (ClothActivity::Ticking | ClothActivity::OverBudget, Some(unseen)) if is_overdue => {
                unseen
            }
            (ClothActivity::OffScreen | ClothActivity::OutOfRange, Some(unseen)) => unseen,
            (ClothActivity::OffScreen | ClothActivity::OutOfRange, None) => ClothActivity::Ticking,
            (ClothActivity::AtRest, None) if wants_finer => ClothActivity::Ticking,
            _ => old,
        };
        if new != old {
            self.instance.activity = new;
        }
        new == ClothActivity::Ticking && old != new && old != ClothActivity::AtRest
    }
}
