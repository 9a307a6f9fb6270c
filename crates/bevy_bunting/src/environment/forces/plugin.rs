//! Applies impulses, and reports forces that cannot be used.

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;

use crate::environment::forces::acceleration::{ClothAcceleration, report_accelerations};
use crate::environment::forces::impulse::{
    Impulses, apply_impulses, queue_impulse, shift_impulses,
};
use crate::motion::grow::grow_cloths;
use crate::schedule::{ClothSystems, ClothTick};

/// Handles [`ClothImpulse`](crate::ClothImpulse) and [`ClothAcceleration`].
#[derive(Debug, Default)]
pub struct ForcePlugin;

impl Plugin for ForcePlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<ClothAcceleration>()
            .init_resource::<Impulses>()
            .add_observer(queue_impulse)
            .add_observer(shift_impulses)
            .add_systems(
                ClothTick,
                (report_accelerations, apply_impulses)
                    .in_set(ClothSystems::Prepare)
                    .after(grow_cloths),
            );
    }
}
