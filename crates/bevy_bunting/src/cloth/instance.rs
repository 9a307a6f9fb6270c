//! A cloth as it is simulated: its fabrics, its level, and where its state is.

use std::sync::Arc;

use bevy_ecs::lifecycle::HookContext;
use bevy_ecs::prelude::*;
use bevy_ecs::world::DeferredWorld;
use bevy_math::Vec3;
use bunting_solver::{ClothSnapshot, Fabric, FabricMaterial};

use crate::batch::batches::{ClothBatches, Slot};
use crate::cloth::activity::ClothActivity;
use crate::cloth::imperfection::{ClothSeed, almost_at_rest};
use crate::cloth::state::ClothState;
use crate::fabric::levels::ClothLevels;

/// Where the state of a cloth is.
#[derive(Clone, Debug, Default)]
pub(crate) enum Place {
    /// It has none: it cannot be simulated.
    #[default]
    Nowhere,
    /// Outside of any batch: not yet seated, or paused.
    Waiting(ClothSnapshot),
    /// In a lane.
    Seated(Slot),
}

/// The simulated side of a [`ClothMesh`](crate::ClothMesh).
#[derive(Component, Clone, Debug, Default)]
#[component(on_insert = take_state)]
pub(crate) struct ClothInstance {
    pub levels: Option<Arc<ClothLevels>>,
    pub level: usize,
    pub place: Place,
    /// Chooses its imperfection.
    pub seed: ClothSeed,
    /// It is as it was cut, almost at rest, and has not been in a lane since.
    pub unmoved: bool,
    /// Its fabrics are being cut.
    pub cutting: bool,
    pub activity: ClothActivity,
    /// The last good material.
    pub material: FabricMaterial,
    /// Gravity in the last tick, along the axes of the cloth's frame, m/s².
    pub gravity: Vec3,
    /// The attachment's target that the levels were cut for; the cloth itself stands for its own
    /// transform, none for no attachment.
    pub target: Option<Entity>,
    /// The target is gone, and that was dealt with.
    pub target_lost: bool,
    /// It was paused for that.
    pub frozen: bool,
    /// There was never a target, and that was reported: it is looked for in each tick.
    pub awaits_target: Option<Entity>,
    /// The pose to follow is not finite, and that was reported.
    pub pose_reported: bool,
}

/// A clone has a state of its own: that of its original, copied out of the lane that both believe to be in.
fn take_state(mut world: DeferredWorld, context: HookContext) {
    let instance = world.get::<ClothInstance>(context.entity);
    let Some(slot) = instance.and_then(ClothInstance::slot) else { return };
    let batches = world.get_resource::<ClothBatches>();
    let Some(snapshot) = batches.and_then(|batches| batches.of_another(slot, context.entity))
    else {
        return;
    };
    if let Some(mut instance) = world.get_mut::<ClothInstance>(context.entity) {
        instance.place = Place::Waiting(snapshot);
    }
}

impl ClothInstance {
    /// The lane of the cloth, if it has one.
    pub fn slot(&self) -> Option<Slot> {
        match self.place {
            Place::Seated(slot) => Some(slot),
            _ => None,
        }
    }

    /// The state of a cloth that is in no lane.
    pub fn waiting(&self) -> Option<&ClothSnapshot> {
        match &self.place {
            Place::Waiting(snapshot) => Some(snapshot),
            _ => None,
        }
    }

    /// Where the particle in the middle is at rest, in the cloth's frame, m.
    pub fn rest_middle(&self) -> Vec3 {
        let rest = self.fabric().map_or(&[][..], |fabric| fabric.rest_positions());
        rest.get(rest.len() / 2).copied().unwrap_or_default()
    }

    /// The fabric of the cloth at its level.
    pub fn fabric(&self) -> Option<&Arc<Fabric>> {
        self.levels.as_ref().map(|levels| levels.fabric(self.level))
    }

    /// Ends a rest: what acts on the cloth has changed.
    pub fn wake(&mut self) {
        if self.activity == ClothActivity::AtRest {
            self.activity = ClothActivity::Ticking;
        }
    }

    /// Takes the state out of its lane.
    pub fn unseat(&mut self, batches: &mut ClothBatches) {
        if let Place::Seated(slot) = self.place {
            self.place = Place::Waiting(batches.take(slot));
        }
    }

    /// Moves the state to another level.
    pub fn change_level(&mut self, to: usize, batches: &mut ClothBatches) {
        if let Place::Seated(slot) = self.place {
            self.place = Place::Waiting(batches.take_away(slot));
        }
        if self.unmoved {
            self.level = to;
            self.begin_at_rest();
        } else if let (Some(levels), Place::Waiting(snapshot)) = (&self.levels, &mut self.place) {
            let state = core::mem::take(snapshot);
            *snapshot = levels.transfer(state, (self.level, to), &self.material, self.gravity);
        }
        self.level = to;
    }

    /// Moves the state to a coarser level while nobody looks: with the particles that stay, and without
    /// regard to the others.
    pub fn drop_to(&mut self, to: usize, batches: &mut ClothBatches) {
        if self.unmoved {
            self.level = to;
            self.begin_at_rest();
        } else if let Some(levels) = &self.levels {
            let shared = levels.shared(self.level, to);
            let state = match &self.place {
                Place::Nowhere => None,
                Place::Waiting(snapshot) => Some(snapshot.of(&shared)),
                Place::Seated(slot) => Some(batches.take_some(*slot, &shared)),
            };
            let calm = |state| Place::Waiting(levels.calm(state, to, &self.material));
            self.place = state.map_or(Place::Nowhere, calm);
        }
        self.level = to;
    }

    /// Takes other fabrics. The state is kept if it fits, as when only the pins change, and then told whether
    /// it was: its pins are where they were. Else the cloth begins at rest.
    pub fn recut(&mut self, levels: Arc<ClothLevels>, batches: &mut ClothBatches) -> bool {
        self.wake();
        self.unseat(batches);
        let level = self.level.min(levels.count() - 1);
        let fits = level == self.level
            && !self.unmoved
            && self
                .fabric()
                .is_some_and(|old| old.rest_positions() == levels.fabric(level).rest_positions());
        self.level = level;
        self.levels = Some(levels);
        let kept = fits && matches!(self.place, Place::Waiting(_));
        if !kept {
            self.begin_at_rest();
        }
        kept
    }

    /// Puts the cloth back to rest, and shows it so. Whether there is a cloth.
    pub fn put_to_rest(&mut self, state: &mut ClothState, batches: &mut ClothBatches) -> bool {
        self.wake();
        let Some(levels) = self.levels.clone() else { return false };
        let rest = almost_at_rest(levels.fabric(self.level), self.seed);
        state.begin_anew(self.level, &levels, &rest.positions);
        match self.place {
            Place::Seated(slot) => batches.lane(slot).restore(&rest),
            _ => self.begin_at_rest(),
        }
        true
    }

    /// Lets the cloth wait for a lane, almost at rest.
    fn begin_at_rest(&mut self) {
        if let Some(fabric) = self.fabric() {
            self.place = Place::Waiting(almost_at_rest(fabric, self.seed));
            self.unmoved = true;
        }
    }

    /// Ends the simulation.
    pub fn clear(&mut self, batches: &mut ClothBatches) {
        self.unseat(batches);
        *self = Self::default();
    }
}
