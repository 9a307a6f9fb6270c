//! Cloth that does not pass through itself.

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;

use crate::batch::batches::ClothBatches;
use crate::cloth::instance::ClothInstance;
use crate::environment::drive::drive_cloths;
use crate::environment::drive_colliders::drive_colliders;
use crate::schedule::{ClothSystems, ClothTick};

/// Keeps a cloth from passing through itself. Without this component it does. Friction between layers is the material's
/// `surface_friction`.
///
/// A cloth that hardly folds pays for the search alone; the more layers lie upon one another, the more it costs.
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
pub struct SelfCollision {
    /// Distance that layers keep, m; less where the mesh's own layers are nearer at rest.
    pub thickness: f32,
    /// Number of levels of detail that do not pass through themselves: the finest ones. Coarser levels do.
    pub levels: usize,
}

impl Default for SelfCollision {
    /// Layers 5 mm apart, at the finest level.
    fn default() -> Self {
        Self { thickness: 5e-3, levels: 1 }
    }
}

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
fn drive_self_collisions(
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
        let settings = bunting_solver::SelfCollision { thickness };
        batches.lane(lane).set_self_collision((instance.level < levels).then_some(settings));
    }
}
