//! Wind that is felt at each particle of a cloth.

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;

use crate::batch::batches::ClothBatches;
use crate::cloth::instance::ClothInstance;
use crate::cloth::state::ClothState;
use crate::environment::drive::drive_cloths;
use crate::environment::drive_colliders::drive_colliders;
use crate::environment::surroundings::{Exposure, Surroundings};
use crate::motion::pose::PoseHistory;
use crate::schedule::{ClothSystems, ClothTick};

/// The cloth feels the air at each of its particles, for fans, blasts and gusts that are smaller than it is. Without this
/// component it feels the air at its middle, which costs nothing more.
///
/// The wind is taken where the particles were at the end of the last tick, so that a new cloth, and one that has changed its
/// level of detail, feels that at its middle for a tick. Each particle takes as long as a whole cloth does without this
/// component, and each substep some loops over the particles more.
///
/// ```
/// use bevy_bunting::prelude::*;
///
/// // A curtain of which a fan blows at one half.
/// let curtain = (ClothMesh::grid(17, 17, 2.0, 2.0), WindPerParticle);
/// # let _ = curtain;
/// ```
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
pub struct WindPerParticle;

/// Samples the winds at the particles of cloths that ask for it.
#[derive(Debug, Default)]
pub struct WindPerParticlePlugin;

impl Plugin for WindPerParticlePlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<WindPerParticle>().add_observer(end_sampling).add_systems(
            ClothTick,
            // Colliders are sought as far as the wind moves the particles.
            sample.in_set(ClothSystems::Drive).after(drive_cloths).before(drive_colliders),
        );
    }
}

type SampledCloth = (&'static ClothInstance, &'static PoseHistory, &'static ClothState);

/// Sets the wind at each particle.
fn sample(
    cloths: Query<(SampledCloth, Exposure), With<WindPerParticle>>,
    surroundings: Surroundings,
    mut batches: ResMut<ClothBatches>,
) {
    for ((instance, frame, state), exposure) in &cloths {
        let Some(lane) = instance.lane() else { continue };
        let Some(fabric) = instance.fabric() else { continue };
        let positions = state.positions();
        if state.level != instance.level || positions.len() != fabric.particle_count() {
            continue;
        }
        let (pose, motion) = (frame.end(), frame.motion());
        let felt = |wind: Vec3| surroundings.felt(wind, pose, &motion, &exposure);
        let size = instance.growth.end();
        let of_middle = felt(surroundings.wind_at(pose * (size * instance.rest_middle)));
        let mut winds = Vec::new();
        let places = positions.iter().map(|&position| pose * (size * position));
        surroundings.winds_at(places, &mut winds);
        winds.iter_mut().for_each(|wind| *wind = (felt(*wind) - of_middle) / size);
        if winds.iter().all(|wind| *wind == Vec3::ZERO) {
            winds.clear();
        }
        batches.lane(lane).set_local_wind(winds);
    }
}

/// Lets a cloth feel the air at its middle again.
fn end_sampling(
    removed: On<Remove, WindPerParticle>,
    cloths: Query<&ClothInstance>,
    mut batches: ResMut<ClothBatches>,
) {
    if let Ok(instance) = cloths.get(removed.entity)
        && let Some(lane) = instance.lane()
    {
        batches.lane(lane).set_local_wind(Vec::new());
    }
}
