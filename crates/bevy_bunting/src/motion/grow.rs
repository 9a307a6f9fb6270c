//! The system that lets cloths grow with what they follow.

use bevy_ecs::prelude::*;

use crate::batch::batches::ClothBatches;
use crate::cloth::error::ClothError;
use crate::cloth::events::ClothFailed;
use crate::cloth::instance::ClothInstance;
use crate::cloth::state::ClothState;
use crate::motion::pose::PoseHistory;

type GrowingCloth =
    (Entity, &'static PoseHistory, &'static mut ClothInstance, &'static mut ClothState);

/// Filter of cloths whose size may be another.
type MayHaveGrown = Or<(Changed<PoseHistory>, Changed<ClothInstance>)>;

/// Gives each cloth the size of what it follows, and reports changes of scale that no cloth can follow.
pub(crate) fn grow_cloths(
    mut cloths: ParamSet<(Query<GrowingCloth, MayHaveGrown>, Query<&mut ClothInstance>)>,
    mut grown: Local<Vec<Entity>>,
    mut batches: ResMut<ClothBatches>,
    mut commands: Commands,
) {
    let mut of_last_tick = cloths.p1();
    for entity in grown.drain(..) {
        if let Ok(mut instance) = of_last_tick.get_mut(entity) {
            // The size itself is not another than before.
            instance.bypass_change_detection().growth.settle();
        }
    }
    for (entity, history, mut instance, mut state) in &mut cloths.p0() {
        let mut growth = instance.growth;
        if growth.follow(history.scale()) {
            let scale = history.scale();
            ClothFailed::report(&mut commands, entity, ClothError::ScaleChange { entity, scale });
        }
        if growth != instance.growth {
            let has_grown = growth.start() != growth.end();
            if has_grown {
                instance.growth = growth;
                grown.push(entity);
                let material = instance.acting_material();
                if let Some(lane) = instance.lane() {
                    batches.lane(lane).set_material(material);
                }
                if !instance.unmoved
                    && let Some(mut moving) = instance.state(&batches)
                {
                    growth.keep_velocities(&mut moving);
                    instance.set_state(moving, &mut batches);
                }
                instance.wake();
            } else {
                instance.bypass_change_detection().growth = growth;
            }
        }
        if state.scale != growth.end() {
            state.scale = growth.end();
        }
    }
}
