//! The simulated side of a cloth: its fabrics, its level, and where its state is stored.

use std::sync::Arc;

use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bunting_solver::{ClothSnapshot, Fabric, FabricMaterial};

use crate::batch::batches::ClothBatches;
use crate::batch::lane_handle::LaneHandle;
use crate::cloth::activity::ClothActivity;
use crate::fabric::levels::ClothLevels;

/// Where the state of a cloth is stored.
#[derive(Clone, Debug, Default)]
pub(crate) enum StateStorage {
    /// There is no state: the cloth cannot be simulated.
    #[default]
    None,
    /// Outside of any batch: the cloth waits for a lane, is paused or asleep.
    Snapshot(ClothSnapshot),
    /// In a lane of a batch.
    Lane(LaneHandle),
}

/// The simulated side of a [`ClothMesh`](crate::ClothMesh).
#[derive(Component, Clone, Debug, Default)]
pub(crate) struct ClothInstance {
    pub levels: Option<Arc<ClothLevels>>,
    pub level: usize,
    pub storage: StateStorage,
    /// Whether the fabrics are being cut on another thread.
    pub cutting: bool,
    pub activity: ClothActivity,
    /// The last valid material.
    pub material: FabricMaterial,
    /// Gravity in the last tick, along the axes of the cloth's frame, m/s².
    pub gravity: Vec3,
    /// The attachment's target that the levels were cut for; the cloth itself stands for its own
    /// transform, none for no attachment.
    pub target: Option<Entity>,
    /// Whether the target was despawned, and that was handled.
    pub target_lost: bool,
    /// Whether the pose to follow is not finite, and that was reported.
    pub pose_reported: bool,
}

impl ClothInstance {
    /// The lane of the cloth, if it has one.
    pub fn lane(&self) -> Option<LaneHandle> {
        match self.storage {
            StateStorage::Lane(lane) => Some(lane),
            _ => None,
        }
    }

    /// The state of a cloth that is in no lane.
    pub fn snapshot(&self) -> Option<&ClothSnapshot> {
        match &self.storage {
            StateStorage::Snapshot(snapshot) => Some(snapshot),
            _ => None,
        }
    }

    /// The fabric of the cloth at its level.
    pub fn fabric(&self) -> Option<&Arc<Fabric>> {
        self.levels.as_ref().map(|levels| levels.fabric(self.level))
    }

    /// Wakes a cloth that sleeps at rest: what acts on it has changed.
    pub fn wake(&mut self) {
        if self.activity == ClothActivity::AtRest {
            self.activity = ClothActivity::Ticking;
        }
    }

    /// Moves the state out of its lane into a snapshot.
    pub fn leave_lane(&mut self, batches: &mut ClothBatches) {
        if let StateStorage::Lane(lane) = self.storage {
            self.storage = StateStorage::Snapshot(batches.remove(lane));
        }
    }

    /// Moves the state to another level, with momentum and energy kept as far as the levels can.
    pub fn change_level(&mut self, to: usize, batches: &mut ClothBatches) {
        if let StateStorage::Lane(lane) = self.storage {
            self.storage = StateStorage::Snapshot(batches.remove_without_history(lane));
        }
        if let (Some(levels), StateStorage::Snapshot(snapshot)) = (&self.levels, &mut self.storage)
        {
            let state = core::mem::take(snapshot);
            *snapshot = levels.transfer(state, (self.level, to), &self.material, self.gravity);
        }
        self.level = to;
    }

    /// Moves the state of a cloth in no viewer's picture to a coarser level: the shared particles keep
    /// their positions and velocities, whatever momentum and energy the others had.
    pub fn change_level_unseen(&mut self, to: usize, batches: &mut ClothBatches) {
        if let Some(levels) = &self.levels {
            let shared = levels.shared(self.level, to);
            let state = match &self.storage {
                StateStorage::None => None,
                StateStorage::Snapshot(snapshot) => Some(snapshot.of(&shared)),
                StateStorage::Lane(lane) => Some(batches.remove_particles(*lane, &shared)),
            };
            let settled = |state| StateStorage::Snapshot(levels.settle(state, to, &self.material));
            self.storage = state.map_or(StateStorage::None, settled);
        }
        self.level = to;
    }

    /// Replaces the fabrics. The state is kept if it fits them, as when only the pins change; else the
    /// cloth starts at rest.
    pub fn replace_levels(&mut self, levels: Arc<ClothLevels>, batches: &mut ClothBatches) {
        self.wake();
        self.leave_lane(batches);
        let level = self.level.min(levels.count() - 1);
        let fits = level == self.level
            && self
                .fabric()
                .is_some_and(|old| old.rest_positions() == levels.fabric(level).rest_positions());
        match &mut self.storage {
            StateStorage::Snapshot(snapshot) if fits => {
                reset_pins(snapshot, levels.fabric(level));
            }
            storage => {
                *storage = StateStorage::Snapshot(ClothSnapshot::at_rest(levels.fabric(level)));
            }
        }
        self.level = level;
        self.levels = Some(levels);
    }

    /// Puts the cloth back to its shape at rest, without velocity.
    pub fn reset(&mut self, batches: &mut ClothBatches) {
        self.wake();
        if let StateStorage::Lane(lane) = self.storage {
            batches.lane(lane).reset();
        } else if let Some(fabric) = self.fabric() {
            self.storage = StateStorage::Snapshot(ClothSnapshot::at_rest(fabric));
        }
    }

    /// Ends the simulation and frees the lane.
    pub fn clear(&mut self, batches: &mut ClothBatches) {
        self.leave_lane(batches);
        *self = Self::default();
    }
}

/// Puts pinned particles exactly at their positions at rest.
fn reset_pins(snapshot: &mut ClothSnapshot, fabric: &Fabric) {
    for (particle, position) in snapshot.positions.iter_mut().enumerate() {
        if fabric.is_pinned(particle) {
            *position = fabric.rest_positions()[particle];
        }
    }
}
