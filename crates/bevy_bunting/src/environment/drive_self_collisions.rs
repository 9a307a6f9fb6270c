//! Sets the distance of layers of cloth that does not pass through itself.

use bevy_app::{App, Plugin};
use bevy_ecs::entity::EntityHashSet;
use bevy_ecs::prelude::*;
use bunting_solver::Fabric;

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

/// Whether a thickness, m, is no distance of a cloth's layers, since the cloth is smaller: all of it would touch all of it.
fn is_too_thick(thickness: f32, fabric: &Fabric) -> bool {
    thickness > fabric.area().sqrt()
}

/// Sets the distance of layers of each cloth in a lane, since a cloth that has entered a lane has none.
pub(crate) fn drive_self_collisions(
    cloths: Query<(Entity, &ClothInstance, Ref<SelfCollision>)>,
    mut removed: RemovedComponents<SelfCollision>,
    instances: Query<&ClothInstance, Without<SelfCollision>>,
    mut batches: ResMut<ClothBatches>,
    mut reported: Local<EntityHashSet>,
) {
    for instance in instances.iter_many(removed.read()) {
        if let Some(lane) = instance.lane() {
            batches.lane(lane).set_self_collision(None);
        }
    }
    reported.retain(|entity| cloths.contains(*entity));
    for (entity, instance, self_collision) in &cloths {
        let Some(lane) = instance.lane() else { continue };
        if self_collision.is_changed() {
            reported.remove(&entity);
        }
        let SelfCollision { thickness, levels } = *self_collision;
        let in_frame = thickness / instance.growth.end();
        let is_too_thick = instance.fabric().is_some_and(|fabric| is_too_thick(in_frame, fabric));
        if is_too_thick && reported.insert(entity) {
            log::error!(
                "the SelfCollision of {entity} has a thickness of {thickness} m, and the cloth is smaller: it passes through itself \
                 until the thickness is a distance of its layers, as 0.005 m"
            );
        }
        let settings = bunting_solver::SelfCollision { thickness: in_frame };
        let is_kept = instance.level < levels && !is_too_thick;
        batches.lane(lane).set_self_collision(is_kept.then_some(settings));
    }
}
