//! The plugin and its order against avian's.

use avian3d::schedule::{PhysicsSchedule, PhysicsStepSystems, PhysicsSystems};
use bevy_app::{App, FixedPostUpdate, Plugin};
use bevy_bunting::{ClothSystems, ClothTick, run_cloth_tick};
use bevy_ecs::intern::Interned;
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::ScheduleLabel;

use crate::colliders::{copy_colliders, forget_colliders};
use crate::feels::{FeelsCloth, ask_for_anchors, ask_for_contacts};
use crate::former_reaction::FormerReaction;
use crate::layers::copy_layers;
use crate::push::{pull_by_anchors, push_by_contacts};

/// Makes avian's colliders those of cloth, and lets bodies with [`FeelsCloth`] feel it.
#[derive(Debug)]
pub struct ClothAvianPlugin {
    host: Interned<dyn ScheduleLabel>,
}

impl ClothAvianPlugin {
    /// A plugin for apps in which both `PhysicsPlugins` and `ClothPlugins` run in the given schedule.
    #[must_use]
    pub fn new(schedule: impl ScheduleLabel) -> Self {
        Self { host: schedule.intern() }
    }
}

impl Default for ClothAvianPlugin {
    /// A plugin for `FixedPostUpdate`, the default of both.
    fn default() -> Self {
        Self::new(FixedPostUpdate)
    }
}

impl Plugin for ClothAvianPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<FeelsCloth>()
            .register_type::<FormerReaction>()
            .configure_sets(self.host, PhysicsSystems::Last.before(run_cloth_tick))
            .add_systems(
                PhysicsSchedule,
                (push_by_contacts, pull_by_anchors).chain().before(PhysicsStepSystems::First),
            )
            .add_systems(
                ClothTick,
                (forget_colliders, copy_colliders, copy_layers, ask_for_contacts, ask_for_anchors)
                    .chain()
                    .before(ClothSystems::Prepare),
            );
    }
}
