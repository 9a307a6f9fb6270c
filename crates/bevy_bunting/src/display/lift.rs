//! Lifts the displayed surface out of colliders, see [`SurfaceLift`].

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;
use bunting_solver::SurfaceLift;

use crate::batch::batches::ClothBatches;
use crate::cloth::instance::ClothInstance;
use crate::cloth::state::ClothState;
use crate::display::ease::ease_surfaces;
use crate::display::easing::ClothEasing;
use crate::display::lifting::ClothLift;
use crate::schedule::{ClothSystems, ClothTick};

/// Lifts displayed surfaces out of colliders.
#[derive(Debug, Default)]
pub struct LiftPlugin;

impl Plugin for LiftPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(
            ClothTick,
            lift_surfaces.in_set(ClothSystems::Publish).after(ease_surfaces),
        );
    }
}

pub(crate) fn lift_surfaces(
    mut cloths: Query<(&ClothInstance, &ClothState, &ClothEasing, &mut ClothLift)>,
    batches: Res<ClothBatches>,
    mut surface: Local<SurfaceLift>,
) {
    for (instance, state, easing, mut lift) in &mut cloths {
        let lift = &mut *lift;
        let (Some(lane), Some(levels)) = (instance.lane(), &instance.levels) else {
            if instance.unmoved {
                lift.current.clear();
            }
            lift.previous.clone_from(&lift.current);
            continue;
        };
        core::mem::swap(&mut lift.previous, &mut lift.current);
        let (level, positions) = match easing.level() {
            Some(level) => (level, &easing.positions),
            None => (state.level, &state.positions),
        };
        if level != lift.level {
            lift.previous.clear();
            lift.level = level;
        }
        let near = batches.near_colliders(lane);
        let thickness = instance.acting_material().thickness;
        surface.compute(levels.fabric(level), positions, thickness, near, &mut lift.current);
    }
}
