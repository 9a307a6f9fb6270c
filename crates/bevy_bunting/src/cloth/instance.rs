//! The simulated side of a cloth: its fabrics, its level, and where its state is stored.

use std::sync::Arc;

use bevy_ecs::lifecycle::HookContext;
use bevy_ecs::prelude::*;
use bevy_ecs::world::DeferredWorld;
use bevy_math::Vec3;
use bunting_solver::{ClothSnapshot, Fabric, FabricMaterial};

use crate::batch::batches::ClothBatches;
use crate::batch::lane_handle::LaneHandle;
use crate::cloth::activity::ClothActivity;
use crate::cloth::imperfection::{ClothSeed, almost_at_rest};
use crate::cloth::state::ClothState;
use crate::fabric::levels::ClothLevels;
use crate::motion::take_up::TakingUp;

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
#[component(on_insert = copy_state)]
pub(crate) struct ClothInstance {
    pub levels: Option<Arc<ClothLevels>>,
    pub level: usize,
    pub storage: StateStorage,
    /// Seed of its imperfection.
    pub seed: ClothSeed,
    /// Whether it is almost at rest, as it was cut, and was in no lane since.
    pub unmoved: bool,
    /// What the fabrics depend on that are being cut on another thread, see `FabricLibrary`.
    pub cutting: Option<Vec<u32>>,
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
    /// Whether the cloth was paused for that.
    pub frozen: bool,
    /// A target without a transform, which was reported, and is looked for in each tick.
    pub missing_target: Option<Entity>,
    /// The way of attached vertices that are not in their places yet.
    pub taking_up: Option<TakingUp>,
    /// Whether the pose to follow is not finite, and that was reported.
    pub pose_reported: bool,
}

/// Gives a clone of a cloth a state of its own: a copy of the state in the lane of the original.
fn copy_state(mut world: DeferredWorld, context: HookContext) {
    let instance = world.get::<ClothInstance>(context.entity);
    let Some(lane) = instance.and_then(ClothInstance::lane) else { return };
    let batches = world.get_resource::<ClothBatches>();
    let Some(state) = batches.and_then(|batches| batches.state_of_other(lane, context.entity))
    else {
        return;
    };
    if let Some(mut instance) = world.get_mut::<ClothInstance>(context.entity) {
        instance.storage = StateStorage::Snapshot(state);
    }
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

    /// Position at rest of the middle particle in the cloth's frame, m.
    pub fn rest_middle(&self) -> Vec3 {
        let rest = self.fabric().map_or(&[][..], |fabric| fabric.rest_positions());
        rest.get(rest.len() / 2).copied().unwrap_or_default()
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
        if self.unmoved {
            self.level = to;
            self.start_at_rest();
        } else if let (Some(levels), StateStorage::Snapshot(snapshot)) =
            (&self.levels, &mut self.storage)
        {
            let state = core::mem::take(snapshot);
            *snapshot = levels.transfer(state, (self.level, to), &self.material, self.gravity);
        }
        self.level = to;
    }

    /// Moves the state of a cloth in no viewer's picture to a coarser level: the shared particles keep
    /// their positions and velocities, whatever momentum and energy the others had.
    pub fn change_level_unseen(&mut self, to: usize, batches: &mut ClothBatches) {
        if self.unmoved {
            self.level = to;
            self.start_at_rest();
        } else if let Some(levels) = &self.levels {
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

    /// Replaces the fabrics. The state is kept if it fits them, as when only the pins change, and the pins then
    /// stay where they are; else the cloth starts at rest. Returns whether the state was kept.
    pub fn replace_levels(&mut self, levels: Arc<ClothLevels>, batches: &mut ClothBatches) -> bool {
        self.wake();
        self.leave_lane(batches);
        let level = self.level.min(levels.count() - 1);
        let fits = level == self.level
            && !self.unmoved
            && self
                .fabric()
                .is_some_and(|old| old.rest_positions() == levels.fabric(level).rest_positions());
        self.level = level;
        self.levels = Some(levels);
        let keeps = fits && self.snapshot().is_some();
        if !keeps {
            self.start_at_rest();
        }
        keeps
    }

    /// Puts the cloth back to its shape at rest, without velocity, and shows it so.
    pub fn reset(&mut self, state: &mut ClothState, batches: &mut ClothBatches) {
        self.wake();
        self.taking_up = None;
        let Some(levels) = self.levels.clone() else { return };
        let rest = almost_at_rest(levels.fabric(self.level), self.seed);
        state.restart(self.level, &levels, &rest.positions);
        match self.storage {
            StateStorage::Lane(lane) => batches.lane(lane).restore(&rest),
            _ => self.start_at_rest(),
        }
    }

    /// Lets the cloth wait for a lane, almost at rest.
    fn start_at_rest(&mut self) {
        self.taking_up = None;
        if let Some(fabric) = self.fabric() {
            self.storage = StateStorage::Snapshot(almost_at_rest(fabric, self.seed));
            self.unmoved = true;
        }
    }

    /// Ends the simulation and frees the lane.
    pub fn clear(&mut self, batches: &mut ClothBatches) {
        self.leave_lane(batches);
        *self = Self::default();
    }
}
