//! Cloths get and lose the components that their skins need.

use bevy_ecs::prelude::*;

use crate::batch::batches::ClothBatches;
use crate::cloth::error::ClothError;
use crate::cloth::events::ClothFailed;
use crate::cloth::instance::ClothInstance;
use crate::cloth::mesh::ClothMesh;
use crate::cloth::state::ClothState;
use crate::motion::pose::PoseHistory;
use crate::motion::take_up::TakingUp;
use crate::skeleton::joints::JointPoses;
use crate::skeleton::limits::SkinLimits;
use crate::skeleton::particles::SkinnedParticles;
use crate::skeleton::skin::ClothSkin;
use crate::skeleton::vertex_skins::VertexSkins;

type CheckedSkin = (
    Entity,
    Ref<'static, ClothSkin>,
    Option<Ref<'static, SkinLimits>>,
    Ref<'static, ClothMesh>,
    &'static mut ClothInstance,
    Option<&'static mut SkinnedParticles>,
    &'static PoseHistory,
);
type AnyChanged = Or<(Changed<ClothSkin>, Changed<SkinLimits>, Changed<ClothMesh>)>;

/// What a cloth with a skin needs to be led by it; none if the skin is not valid.
pub(crate) fn led_by(
    mesh: &ClothMesh,
    skin: &ClothSkin,
    limits: Option<&SkinLimits>,
) -> Option<(JointPoses, SkinnedParticles)> {
    let skins = VertexSkins::of(mesh, skin, limits).ok()??;
    Some((JointPoses::new(skin), SkinnedParticles::of(skins)))
}

/// Gives cloths with valid skins [`JointPoses`] and [`SkinnedParticles`], and reports bad skins. The last valid one is kept
/// as long as it fits the mesh.
pub(super) fn check_skins(mut cloths: Query<CheckedSkin, AnyChanged>, mut commands: Commands) {
    for (entity, skin, limits, mesh, mut instance, particles, history) in &mut cloths {
        let has_new = history.has_new(&skin)
            || limits.as_ref().is_some_and(|limits| history.has_new(limits))
            || history.has_new(&mesh);
        if !has_new && particles.is_some() {
            continue;
        }
        instance.wake();
        let error = match VertexSkins::of(&mesh, &skin, limits.as_deref()) {
            // Fabrics of the former mesh are kept, if there are any.
            Ok(None) => continue,
            Ok(Some(skins)) => {
                match particles {
                    Some(mut particles)
                        if particles.skins().skin == *skin && !skin.is_changed() =>
                    {
                        particles.set_skins(skins);
                    }
                    _ => {
                        let particles = SkinnedParticles::of(skins);
                        commands.entity(entity).insert((JointPoses::new(&skin), particles));
                    }
                }
                continue;
            }
            Err(source) => ClothError::Skin { entity, source },
        };
        ClothFailed::report(&mut commands, entity, error);
        let has_vertices = |known: &SkinnedParticles| {
            known.skins().vertex_count() == mesh.vertex_count() || instance.refusal.is_some()
        };
        if !particles.is_some_and(|known| has_vertices(&known)) {
            commands.entity(entity).remove::<(JointPoses, SkinnedParticles)>();
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
        particles.free();
        instance.wake();
    }
}
