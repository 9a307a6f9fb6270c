//! The simulated side of a cloth: its fabrics, its level, and the storage of its state.

use std::sync::Arc;

use bevy_ecs::lifecycle::HookContext;
use bevy_ecs::prelude::*;
use bevy_ecs::world::DeferredWorld;
use bevy_math::{Mat3, Vec3};
use bunting_solver::{ClothSnapshot, Fabric, FabricMaterial};

use crate::batch::batches::ClothBatches;
use crate::batch::lane_handle::LaneHandle;
use crate::cloth::activity::ClothActivity;
use crate::cloth::error::ClothError;
use crate::cloth::imperfection::{ClothSeed, almost_at_rest};
use crate::cloth::resolution::ClothResolution;
use crate::cloth::restored::{Pending, Restored};
use crate::cloth::state::ClothState;
use crate::fabric::awaited::AwaitedLevels;
use crate::fabric::levels::ClothLevels;
use crate::fabric::same_surface::{MovedState, on_other_particles};
use crate::lod::lod_set::LodSet;
use crate::motion::growth::Growth;
use crate::motion::inertia::ClothInertia;
use crate::motion::take_up::TakingUp;

/// Storage of a cloth's state.
#[derive(Clone, Debug, Default)]
pub(crate) enum StateStorage {
    /// No state: the cloth cannot be simulated.
    #[default]
    None,
    /// A snapshot outside of any batch: the cloth waits for a lane, is paused or asleep.
    /// Boxed: each tick walks over the instances, and nearly all of them have lanes.
    Snapshot(Box<ClothSnapshot>),
    /// A lane of a batch.
    Lane(LaneHandle),
}

impl From<ClothSnapshot> for StateStorage {
    fn from(snapshot: ClothSnapshot) -> Self {
        Self::Snapshot(Box::new(snapshot))
    }
}

/// A mesh or an attachment that cannot be used. The cloth keeps its former fabrics, if it has any.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Refusal {
    /// The defect, which was reported.
    pub error: ClothError,
    /// Target of the present attachment, see [`ClothInstance::target`].
    pub target: Option<Entity>,
    /// Whether the attachment is another than that of the fabrics.
    pub has_new_attachment: bool,
}

/// What a cloth keeps of its state with other fabrics.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kept {
    /// It starts at rest.
    Nothing,
    /// All.
    State,
    /// The surface, on other particles.
    Surface {
        /// Whether all pins were pins before.
        had_pins: bool,
    },
}

/// The simulated side of a [`ClothMesh`](crate::ClothMesh).
#[derive(Component, Clone, Debug, Default)]
#[component(on_insert = copy_state)]
pub(crate) struct ClothInstance {
    pub levels: Option<Arc<ClothLevels>>,
    /// The last valid [`LodSet`], for which the levels were built.
    pub lods: LodSet,
    /// The resolution that the levels were last asked for in.
    pub resolution: ClothResolution,
    /// Whether the levels were last asked for with [`ClothRegions`](crate::ClothRegions).
    pub has_regions: bool,
    /// Why the present `LodSet` is not used; none if it is.
    pub bad_lods: Option<ClothError>,
    pub level: usize,
    /// Position at rest of the middle particle of the finest level in the cloth's frame, m. Each tick reads it here,
    /// since fabrics of many different cloths are not in the cache.
    pub rest_middle: Vec3,
    pub storage: StateStorage,
    /// Seed of the cloth's imperfection.
    pub seed: ClothSeed,
    /// Whether the state is still the initial one, at rest with the imperfection, and has been in no lane.
    pub unmoved: bool,
    /// Scale and shear that are baked into the fabrics.
    pub scale: Mat3,
    /// How many times as large as its fabrics the cloth is.
    pub growth: Growth,
    /// Levels that another thread is building for this cloth.
    pub cutting: Option<AwaitedLevels>,
    pub activity: ClothActivity,
    /// The last valid material.
    pub material: FabricMaterial,
    /// Gravity in the last tick, along the axes of the cloth's frame and in its units, m/s² of cloth that has not grown.
    pub gravity: Vec3,
    /// Inertia in the last tick, on which the meaning of the velocities depends; none before the first.
    pub inertia: Option<ClothInertia>,
    /// Target that the levels were built for: the attachment's, or the cloth itself if it is attached to its
    /// own transform; none without an attachment.
    pub target: Option<Entity>,
    /// Whether the loss of the target has been handled.
    pub target_lost: bool,
    /// Whether the loss of the target paused the cloth.
    pub frozen: bool,
    /// Why the present mesh or attachment was refused; none if they are those of the levels.
    pub refusal: Option<Box<Refusal>>,
    /// Motion of attached vertices that have not reached their places yet.
    pub taking_up: Option<TakingUp>,
    /// Whether the state lies on the pose of the skeleton, if there is one, and not at rest.
    pub is_posed: bool,
    /// Whether a pose that is not finite was reported.
    pub pose_reported: bool,
    /// Until the next tick ends, what a restoration has brought.
    pub restored: Option<Box<Restored>>,
}

/// Gives a clone of a cloth its own copy of the original's state.
fn copy_state(mut world: DeferredWorld, context: HookContext) {
    let instance = world.get::<ClothInstance>(context.entity);
    let Some(lane) = instance.and_then(ClothInstance::lane) else { return };
    let batches = world.get_resource::<ClothBatches>();
    let Some(state) = batches.and_then(|batches| batches.state_of_other(lane, context.entity))
    else {
        return;
    };
    if let Some(mut instance) = world.get_mut::<ClothInstance>(context.entity) {
        instance.storage = state.into();
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

    /// The fabric of the cloth at its level.
    pub fn fabric(&self) -> Option<&Arc<Fabric>> {
        self.levels.as_ref().map(|levels| levels.fabric(self.level))
    }

    /// The material with which the solver simulates the cloth, in the units of its frame.
    pub fn acting_material(&self) -> FabricMaterial {
        self.growth.material(&self.material)
    }

    /// Whether the cloth has fabrics of a former attachment, since the present one was refused.
    pub fn keeps_attachment(&self) -> bool {
        self.levels.is_some() && self.refusal.as_deref().is_some_and(|it| it.has_new_attachment)
    }

    /// Whether the cloth waits for a target that has no transform. It looks for it in each tick.
    pub fn awaits_target(&self) -> bool {
        let is_missing = |it: &Refusal| matches!(it.error, ClothError::MissingTarget { .. });
        self.refusal.as_deref().is_some_and(is_missing)
    }

    /// What the cloth does, as users are told.
    pub fn published_activity(&self) -> ClothActivity {
        match (&self.levels, &self.storage) {
            (None, _) if self.cutting.is_some() => ClothActivity::AwaitsFabric,
            (None, _) if self.refusal.is_some() => ClothActivity::Failed,
            (Some(_), StateStorage::None) => ClothActivity::AwaitsPreroll,
            _ => self.activity,
        }
    }

    /// Wakes a cloth that sleeps at rest, after a change of anything that acts on it.
    pub fn wake(&mut self) {
        if self.activity == ClothActivity::AtRest {
            self.activity = ClothActivity::Ticking;
        }
    }

    /// A copy of the state, between two ticks, wherever it is stored.
    pub fn state(&self, batches: &ClothBatches) -> Option<ClothSnapshot> {
        match &self.storage {
            StateStorage::None => None,
            StateStorage::Snapshot(snapshot) => Some((**snapshot).clone()),
            StateStorage::Lane(lane) => Some(batches.batch(*lane).snapshot(lane.lane)),
        }
    }

    /// Overwrites the state by a finite one of the same fabric, between two ticks, and wakes the cloth.
    pub fn set_state(&mut self, state: ClothSnapshot, batches: &mut ClothBatches) {
        match self.storage {
            StateStorage::Lane(lane) => batches.lane(lane).restore(&state),
            _ => self.storage = state.into(),
        }
        self.unmoved = false;
        self.wake();
    }

    /// Moves the state out of its lane into a snapshot.
    pub fn leave_lane(&mut self, batches: &mut ClothBatches) {
        if let StateStorage::Lane(lane) = self.storage {
            self.storage = batches.remove(lane).into();
        }
    }

    /// Moves the state to another level and keeps momentum and energy as far as the levels allow.
    pub fn change_level(&mut self, to: usize, batches: &mut ClothBatches) {
        if let StateStorage::Lane(lane) = self.storage {
            self.storage = batches.remove_without_history(lane).into();
        }
        let material = self.acting_material();
        if self.unmoved {
            self.level = to;
            self.start_at_rest();
        } else if let (Some(levels), StateStorage::Snapshot(snapshot)) =
            (&self.levels, &mut self.storage)
        {
            let state = core::mem::take(&mut **snapshot);
            **snapshot = levels.transfer(state, (self.level, to), &material, self.gravity);
        }
        self.level = to;
    }

    /// Moves the state of a cloth outside every viewer's picture to a coarser level: the shared particles
    /// keep their positions and velocities; momentum and energy are not kept.
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
            let relaxed = |state| levels.relax(state, to).into();
            self.storage = state.map_or(StateStorage::None, relaxed);
        }
        self.level = to;
    }

    /// Replaces the fabrics. A state that fits them, as when only the pins change, is kept, and the pins stay
    /// where they are. On other particles of the same surface it is interpolated. Otherwise the cloth starts at rest.
    pub fn replace_levels(&mut self, levels: Arc<ClothLevels>, batches: &mut ClothBatches) -> Kept {
        self.wake();
        self.leave_lane(batches);
        let level = self.level.min(levels.count() - 1);
        let fits = level == self.level
            && !self.unmoved
            && self
                .fabric()
                .is_some_and(|old| old.rest_positions() == levels.fabric(level).rest_positions());
        let other = self.levels.as_ref().filter(|old| !fits && old.has_surface_of(&levels));
        let moved = self.snapshot().zip(other).filter(|_| !self.unmoved);
        let moved = moved.and_then(|(state, old)| {
            on_other_particles(state, old.fabric(self.level), levels.fabric(level))
        });
        self.level = level;
        let rest = levels.fabric(0).rest_positions();
        self.rest_middle = rest.get(rest.len() / 2).copied().unwrap_or_default();
        self.levels = Some(levels);
        if let Some(MovedState { state, had_pins }) = moved {
            self.storage = state.into();
            return Kept::Surface { had_pins };
        }
        if fits && self.snapshot().is_some() {
            return Kept::State;
        }
        self.start_at_rest();
        Kept::Nothing
    }

    /// Resets the cloth to its shape at rest, without velocity, and shows that shape.
    pub fn reset(&mut self, state: &mut ClothState, batches: &mut ClothBatches) {
        self.wake();
        self.taking_up = None;
        self.is_posed = false;
        let Some(levels) = self.levels.clone() else { return };
        let rest = almost_at_rest(levels.fabric(self.level), self.seed);
        state.restart(self.level, &levels, &rest.positions);
        match self.storage {
            StateStorage::Lane(lane) => batches.lane(lane).restore(&rest),
            _ => self.start_at_rest(),
        }
    }

    /// Stores a snapshot at rest, with the imperfection; the cloth then waits for a lane.
    fn start_at_rest(&mut self) {
        self.taking_up = None;
        self.is_posed = false;
        if let Some(fabric) = self.fabric() {
            self.storage = almost_at_rest(fabric, self.seed).into();
            self.unmoved = true;
        }
    }

    /// Ends the simulation and frees the lane.
    pub fn clear(&mut self, batches: &mut ClothBatches) {
        self.leave_lane(batches);
        *self = Self::default();
    }
}

/// Whether a cloth has changed since a system last ran; of a restored cloth, since it was restored, or if the system is to
/// see a change from before it was saved.
pub(crate) fn has_changed(instance: &Mut<ClothInstance>, is_pending: fn(&Pending) -> bool) -> bool {
    match &instance.restored {
        None => instance.is_changed(),
        Some(it) => is_pending(&it.pending) || it.at.is_before(instance.last_changed()),
    }
}
