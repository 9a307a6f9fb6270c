//! Cloths get and lose the components that their skins need.

use bevy_ecs::prelude::*;

use crate::batch::batches::ClothBatches;
use crate::cloth::error::ClothError;
use crate::cloth::events::ClothFailed;
use crate::cloth::instance::ClothInstance;
use crate::cloth::mesh::ClothMesh;
use crate::cloth::state::ClothState;
use crate::motion::take_up::TakingUp;
use crate::skeleton::joints::JointPoses;
use crate::skeleton::limits::SkinLimits;
use crate::skeleton::particles::SkinnedParticles;
use crate::skeleton::skin::ClothSkin;

type CheckedSkin = (
    Entity,
    Ref<'static, ClothSkin>,
    Option<&'static SkinLimits>,
    &'static ClothMesh,
    Option<&'static mut SkinnedParticles>,
);
type AnyChanged = Or<(Changed<ClothSkin>, Changed<SkinLimits>, Changed<ClothMesh>)>;

/// Gives cloths with valid skins [`JointPoses`] and [`SkinnedParticles`], and reports bad skins.
pub(super) fn check_skins(mut cloths: Query<CheckedSkin, AnyChanged>, mut commands: Commands) {
    for (entity, skin, limits, mesh, particles) in &mut cloths {
        let limits = || limits.map_or(Ok(()), |limits| limits.of(mesh).map(|_| ()));
        match skin.validate(mesh.vertex_count()).and_then(|()| limits()) {
            Ok(()) => match particles {
                Some(mut particles) if !skin.is_changed() => particles.forget(),
                _ => {
                    let poses = JointPoses::new(&skin);
                    commands.entity(entity).insert((poses, SkinnedParticles::default()));
                }
            },
            Err(source) => {
                commands.entity(entity).remove::<(JointPoses, SkinnedParticles)>();
                ClothFailed::report(&mut commands, entity, ClothError::Skin { entity, source });
            }
        }
    }
}

/// Ends the skinning of a cloth whose [`ClothSkin`] is removed.
pub(super) fn bare(removed: On<Remove, ClothSkin>, mut commands: Commands) {
    commands.entity(removed.entity).try_remove::<(JointPoses, SkinnedParticles)>();
}

/// Leads the pins of a cloth that is skinned no longer back to their places at rest.
pub(super) fn release(
    removed: On<Remove, SkinnedParticles>,
    mut cloths: Query<(&mut ClothInstance, &mut ClothState)>,
    mut batches: ResMut<ClothBatches>,
) {
    let Ok((mut instance, mut shown)) = cloths.get_mut(removed.entity) else { return };
    shown.is_skinned = false;
    if !core::mem::take(&mut instance.is_posed) {
        return;
    }
    if let Some((fabric, state)) = instance.fabric().cloned().zip(instance.state(&batches)) {
        instance.taking_up = Some(TakingUp::from_positions(&fabric, &state.positions));
        instance.wake();
    }
    if let Some(lane) = instance.lane() {
        batches.lane(lane).set_guides(Vec::new());
    }
}

/// Takes the limits of a cloth whose [`SkinLimits`] are removed.
pub(super) fn free(
    removed: On<Remove, SkinLimits>,
    mut cloths: Query<(&mut SkinnedParticles, &mut ClothInstance)>,
) {
    if let Ok((mut particles, mut instance)) = cloths.get_mut(removed.entity) {
        particles.forget();
        instance.wake();
    }
}
