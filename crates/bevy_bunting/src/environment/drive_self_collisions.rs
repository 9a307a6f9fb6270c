//! Sets the distance of layers of cloth that does not pass through itself.

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;

use crate::batch::batches::ClothBatches;
use crate::cloth::instance::ClothInstance;
use crate::environment::drive::drive_cloths;
use crate::environment::drive_colliders::drive_colliders;
use crate::environment::self_collision::SelfCollision;
use crate::schedule::{ClothSystems, ClothTick};

/// Keeps each cloth with a [`SelfCollision`] from passing through itself.
#[derive(Debug, Default)]
pub struct SelfCollisionPlugin;

impl Plugin for SelfCollisionPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<SelfCollision>().add_systems(
            ClothTick,
            (
                report_bad_thickness.in_set(ClothSystems::Prepare),
                drive_self_collisions
                    .in_set(ClothSystems::Drive)
                    .after(drive_cloths)
                    .after(drive_colliders),
            ),
        );
    }
}

/// Reports new and changed components that the solver refuses.
fn report_bad_thickness(cloths: Query<(Entity, &SelfCollision), Changed<SelfCollision>>) {
    for (entity, &SelfCollision { thickness, .. }) in &cloths {
        if !(thickness.is_finite() && thickness > 0.0) {
            log::error!(
                "the SelfCollision of {entity} has a thickness of {thickness} m: the cloth passes through itself until it \
                 is finite and greater than zero"
            );
        }
    }
}

/// Sets the distance of layers of each cloth in a lane, since a cloth that has entered a lane has none.
pub(crate) fn drive_self_collisions(
    cloths: Query<(&ClothInstance, &SelfCollision)>,
    mut removed: RemovedComponents<SelfCollision>,
    instances: Query<&ClothInstance, Without<SelfCollision>>,
    mut batches: ResMut<ClothBatches>,
) {
    for instance in instances.iter_many(removed.read()) {
        if let Some(lane) = instance.lane() {
            batches.lane(lane).set_self_collision(None);
        }
    }
    for (instance, &SelfCollision { thickness, levels }) in &cloths {
        let Some(lane) = instance.lane() else { continue };
        let thickness = thickness / instance.growth.end();
        let settings = bunting_solver::SelfCollision { thickness };
        batches.lane(lane).set_self_collision((instance.level < levels).then_some(settings));
    }
}
