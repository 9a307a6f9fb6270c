//! The system that leads attached vertices to their places.

use bevy_ecs::prelude::*;
use bevy_time::Time;

use crate::batch::batches::ClothBatches;
use crate::cloth::instance::ClothInstance;

pub(crate) fn lead_pins(
    mut cloths: Query<&mut ClothInstance>,
    time: Res<Time>,
    mut batches: ResMut<ClothBatches>,
) {
    for mut instance in &mut cloths {
        if instance.taking_up.is_none() {
            continue;
        }
        // Written in every tick: it must not mark the cloth as changed.
        let instance = instance.bypass_change_detection();
        let (Some(lane), Some(fabric)) = (instance.lane(), instance.fabric().cloned()) else {
            continue;
        };
        let mut lane = batches.lane(lane);
        let mut state = lane.snapshot();
        instance
            .taking_up
            .take_if(|way| way.go_on(time.delta_secs(), &fabric, &mut state.positions));
        lane.restore(&state);
    }
}
