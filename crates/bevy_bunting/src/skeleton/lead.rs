//! The system that leads skinned cloths by their skeletons: pins in every tick, the whole cloth where the pose jumps.

use bevy_ecs::prelude::*;
use bevy_time::Time;

use crate::batch::batches::ClothBatches;
use crate::cloth::instance::ClothInstance;
use crate::cloth::state::ClothState;
use crate::motion::take_up::TakingUp;
use crate::skeleton::joints::JointPoses;
use crate::skeleton::particles::SkinnedParticles;

/// Distance of a pin from its place at which it begins to move there over a while, m. Smaller: a change of level,
/// after which pins are interpolated, counts. Larger: pins visibly jump.
const IN_PLACE: f32 = 1e-3;

type LedCloth = (
    &'static mut ClothInstance,
    &'static mut ClothState,
    &'static JointPoses,
    &'static mut SkinnedParticles,
);

pub(super) fn lead_skins(
    mut cloths: Query<LedCloth>,
    time: Res<Time>,
    mut batches: ResMut<ClothBatches>,
) {
    for (mut instance, mut shown, joints, mut particles) in &mut cloths {
        // Written in every tick: it must not mark the cloth as changed.
        let instance = instance.bypass_change_detection();
        let (Some(lane), Some(levels)) = (instance.lane(), instance.levels.clone()) else {
            continue;
        };
        let mut lane = batches.lane(lane);
        let level = instance.level;
        let is_found = particles.fits(&levels, level);
        if !is_found {
            particles.find(&levels, level);
        }
        let [start, end] = instance.growth.matrices(joints.matrices());
        let goes_on = instance.is_posed && particles.matrices() == Some(&start);
        if goes_on && is_found {
            particles.go_on();
        } else {
            particles.begin_at(&start);
        }
        // The shown surface is blended with the animated places instead of those at rest.
        shown.bypass_change_detection().is_skinned = true;
        if !goes_on {
            let mut state = lane.snapshot();
            let is_known = !instance.is_posed || particles.matrices().is_some();
            if is_known {
                let former = particles.matrices().filter(|_| instance.is_posed);
                particles.carry(&mut state.positions, former, &start);
            } else if !particles.are_pins_in_place(&state.positions, IN_PLACE) {
                let pins = || TakingUp::from_positions(levels.fabric(level), &state.positions);
                instance.taking_up.get_or_insert_with(pins);
            }
            if is_known && state.is_finite() {
                lane.restore(&state);
                shown.restart(level, &levels, &state.positions);
            }
            instance.is_posed = true;
        }
        particles.end_at(end);
        let motions = match &mut instance.taking_up {
            Some(way) => way.go_on(time.delta_secs(), |particle| particles.place(particle)),
            None => particles.motions(),
        };
        instance.taking_up.take_if(|way| way.has_ended());
        lane.move_pins(motions);
        lane.set_guides(particles.guides());
    }
}

/// Blends the surfaces of skinned cloths with their animated places.
pub(crate) fn blend_skins(mut cloths: Query<(&ClothInstance, &mut ClothState, &SkinnedParticles)>) {
    for (instance, mut state, particles) in &mut cloths {
        if instance.lane().is_some() && state.is_skinned {
            let state = state.bypass_change_detection();
            particles.blend(state.level, &mut state.positions, &mut state.normals);
        }
    }
}
