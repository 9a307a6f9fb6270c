//! Gives each cloth the air inside it.

use std::sync::{Arc, Weak};

use bevy_app::{App, Plugin};
use bevy_ecs::entity::EntityHashMap;
use bevy_ecs::prelude::*;
use bunting_solver::{BatchError, Fabric};

use crate::batch::batches::ClothBatches;
use crate::cloth::error::ClothError;
use crate::cloth::events::ClothFailed;
use crate::cloth::instance::ClothInstance;
use crate::environment::drive_colliders::drive_colliders;
use crate::environment::drive_self_collisions::drive_self_collisions;
use crate::environment::pressure::ClothPressure;
use crate::schedule::{ClothSystems, ClothTick};

/// Gives each cloth with a [`ClothPressure`] the air inside it.
#[derive(Debug, Default)]
pub struct PressurePlugin;

impl Plugin for PressurePlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<ClothPressure>().add_systems(
            ClothTick,
            (
                report_pressures.in_set(ClothSystems::Prepare),
                drive_pressures
                    .in_set(ClothSystems::Drive)
                    .after(drive_colliders)
                    .before(drive_self_collisions),
            ),
        );
    }
}

/// Reports numbers that cannot be, whenever they change.
fn report_pressures(
    changed: Query<(Entity, &ClothPressure), Changed<ClothPressure>>,
    mut commands: Commands,
) {
    for (entity, air) in &changed {
        if let Some((name, value, rule)) = air.wrong_number() {
            let error = ClothError::Pressure { entity, name, value, rule };
            ClothFailed::report(&mut commands, entity, error);
        }
    }
}

/// Gives each cloth in a lane its air, since a cloth that has entered a lane has none. `refused` are the fabrics of the cloths whose
/// present air is refused, which is reported once.
pub(crate) fn drive_pressures(
    cloths: Query<(Entity, &ClothInstance, Ref<ClothPressure>)>,
    mut removed: RemovedComponents<ClothPressure>,
    instances: Query<&ClothInstance, Without<ClothPressure>>,
    mut batches: ResMut<ClothBatches>,
    mut refused: Local<EntityHashMap<Weak<Fabric>>>,
    mut commands: Commands,
) {
    for entity in removed.read() {
        refused.remove(&entity);
        if let Some(lane) = instances.get(entity).ok().and_then(ClothInstance::lane) {
            let _ = batches.lane(lane).set_pressure(None);
        }
    }
    for (entity, instance, air) in &cloths {
        let (Some(lane), Some(fabric)) = (instance.lane(), instance.fabric()) else { continue };
        let is_same = |of: &Weak<Fabric>| of.as_ptr() == Arc::as_ptr(fabric);
        if !air.is_changed() && refused.get(&entity).is_some_and(is_same) {
            continue;
        }
        let mut lane = batches.lane(lane);
        let Err(error) = lane.set_pressure(Some(instance.growth.pressure((*air).into()))) else {
            refused.remove(&entity);
            continue;
        };
        let _ = lane.set_pressure(None);
        refused.insert(entity, Arc::downgrade(fabric));
        if let BatchError::Open { area } = error {
            ClothFailed::report(&mut commands, entity, ClothError::OpenPressure { entity, area });
        }
    }
}
