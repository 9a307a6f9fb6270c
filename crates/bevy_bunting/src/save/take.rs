//! Takes the state of a cloth.

use std::sync::Arc;

use bevy_ecs::change_detection::Tick;
use bevy_ecs::prelude::*;

use crate::anchors::reactions::AnchorReactions;
use crate::batch::assign::LastAssignment;
use crate::batch::batches::ClothBatches;
use crate::cloth::activity::ClothActivity;
use crate::cloth::instance::ClothInstance;
use crate::cloth::mesh::ClothMesh;
use crate::cloth::regions::ClothRegions;
use crate::cloth::resolution::ClothResolution;
use crate::cloth::restored::Pending;
use crate::cloth::state::ClothState;
use crate::environment::forces::acceleration::ClothAcceleration;
use crate::environment::pressure::ClothPressure;
use crate::environment::wind::influence::WindInfluence;
use crate::environment::wind::per_particle::WindPerParticle;
use crate::fabric::levels::ClothLevels;
use crate::lod::effort::ClothEffort;
use crate::lod::lod_set::LodSet;
use crate::lod::record::LodRecord;
use crate::lod::rest_timer::RestTimer;
use crate::lod::select::LevelSelector;
use crate::lod::sleep::Changes;
use crate::motion::anchor_poses::AnchorPoses;
use crate::motion::attachment::Attachment;
use crate::motion::observation_times::ObservationTimes;
use crate::motion::pose::PoseHistory;
use crate::save::cloth::{SavedCloth, SavedReactions, SavedSkin};
use crate::save::error::SnapshotError;
use crate::save::surface::SavedSurface;
use crate::seams::seam::ClothSeams;
use crate::seams::sewn::SewnCloth;
use crate::skeleton::joints::JointPoses;
use crate::skeleton::particles::SkinnedParticles;

/// Whether a component has changed since a tick of cloth that no system has noted yet.
pub(crate) struct News<'a> {
    world: &'a World,
    changes: &'a Changes,
    now: Tick,
}

impl<'a> News<'a> {
    /// The news of a world; none without the plugins of cloth.
    pub fn of(world: &'a World) -> Option<Self> {
        Some(Self { world, changes: world.get_resource()?, now: world.read_change_tick() })
    }

    /// Whether a component of an entity has changed since the last tick, and since it was restored.
    pub fn has<C: Component>(&self, entity: Entity) -> bool {
        let Ok(entity) = self.world.get_entity(entity) else { return false };
        let restored = entity.get::<PoseHistory>().map(PoseHistory::restored).unwrap_or_default();
        entity.get_ref::<C>().is_some_and(|component| {
            let changed = component.last_changed();
            self.changes.is_since(changed, self.now) && restored.is_before(changed)
        })
    }
}

/// The state of a cloth between two ticks.
///
/// # Errors
///
/// The entity is no cloth, has no state yet, or one that its components will replace.
pub(super) fn take(world: &World, entity: Entity) -> Result<SavedCloth, SnapshotError> {
    let not_a_cloth = SnapshotError::NotACloth { entity };
    let cloth = world.get_entity(entity).map_err(|_| not_a_cloth)?;
    if !cloth.contains::<ClothMesh>() {
        return Err(not_a_cloth);
    }
    let news = News::of(world).ok_or(not_a_cloth)?;
    let instance = cloth.get::<ClothInstance>().ok_or(not_a_cloth)?;
    let (batches, selector, times) = (
        world.get_resource::<ClothBatches>().ok_or(not_a_cloth)?,
        world.get_resource::<LevelSelector>().ok_or(not_a_cloth)?,
        world.get_resource::<ObservationTimes>().ok_or(not_a_cloth)?,
    );
    let not_simulated = SnapshotError::NotSimulated { entity };
    let levels = instance.levels.as_ref().ok_or(not_simulated)?;
    if is_unsettled(&news, cloth, instance) {
        return Err(SnapshotError::Unsettled { entity });
    }
    let state = instance.state(batches).ok_or(not_simulated)?;
    let shown = cloth.get::<ClothState>().ok_or(not_simulated)?;
    let timer = cloth.get::<RestTimer>().cloned().unwrap_or_default();
    // The next tick would wake it.
    let is_exposed = news.has::<WindInfluence>(entity)
        || news.has::<WindPerParticle>(entity)
        || news.has::<ClothAcceleration>(entity)
        || news.has::<ClothPressure>(entity)
        || news.has::<ClothSeams>(entity);
    let wakes = is_exposed && instance.activity == ClothActivity::AtRest;
    let touches = match (&instance.restored, instance.lane()) {
        (Some(restored), _) => restored.touches,
        (None, lane) => lane.is_some_and(|lane| batches.near_colliders(lane).next().is_some()),
    };
    let anchors = cloth.get::<AnchorPoses>();
    Ok(SavedCloth {
        times: *times,
        levels: Some(Arc::clone(levels)),
        level_count: levels.count(),
        fingerprint: levels.fingerprint(instance.level),
        level: instance.level,
        state,
        tick: world.get_resource::<LastAssignment>().map_or(0.0, |last| last.tick),
        in_lane: instance.lane().is_some(),
        seed: instance.seed,
        unmoved: instance.unmoved,
        activity: if wakes { ClothActivity::Ticking } else { instance.activity },
        material: instance.material,
        gravity: instance.gravity,
        inertia: instance.inertia,
        growth: instance.growth,
        target_lost: instance.target_lost,
        frozen: instance.frozen,
        taking_up: instance.taking_up.clone(),
        is_posed: instance.is_posed,
        pending: pending(world, cloth, selector, (wakes, news.has::<LodSet>(entity))),
        touches,
        effort: cloth.get::<ClothEffort>().cloned().unwrap_or_default(),
        record: cloth.get::<LodRecord>().and_then(|record| record.saved(levels, selector.tick)),
        rest_ticks: if is_exposed { 0 } else { timer.ticks },
        rest_places: if is_exposed { Vec::new() } else { timer.places },
        rest_pose: timer.pose,
        rest_rounding: timer.rounding,
        frame: cloth.get::<PoseHistory>().cloned().unwrap_or_default(),
        anchors: anchors.into_iter().flat_map(AnchorPoses::histories).cloned().collect(),
        skin: skin(cloth),
        seams: cloth.get::<SewnCloth>().map(|sewn| sewn.progress.clone()).unwrap_or_default(),
        reactions: cloth.get::<AnchorReactions>().map(|reactions| SavedReactions {
            target: reactions.target,
            anchors: reactions.anchors.clone(),
            pin_velocities: instance.lane().map_or_else(Vec::new, |lane| {
                batches.batch(lane).pin_velocities(lane.lane).to_vec()
            }),
        }),
        surface: SavedSurface::of(cloth, shown),
    })
}

fn skin(cloth: EntityRef) -> Option<SavedSkin> {
    let (joints, particles) = (cloth.get::<JointPoses>()?, cloth.get::<SkinnedParticles>()?);
    let matrices = particles.matrices().map(<[_]>::to_vec);
    Some(SavedSkin { joints: joints.saved(), matrices })
}

/// Whether the next tick will look for other levels.
fn is_unsettled(news: &News, cloth: EntityRef, instance: &ClothInstance) -> bool {
    let entity = cloth.id();
    let resolution = cloth.get::<ClothResolution>().copied().unwrap_or_default();
    let is_attached = cloth.contains::<Attachment>();
    let has_target = instance.target.is_some();
    instance.cutting.is_some()
        || news.has::<ClothMesh>(entity)
        || news.has::<Attachment>(entity)
        || news.has::<ClothRegions>(entity)
        || cloth.contains::<ClothRegions>() != instance.has_regions
        || resolution != instance.resolution
        || (instance.refusal.is_none() && is_attached != has_target)
        || cloth
            .get::<LodSet>()
            .is_some_and(|lods| instance.bad_lods.is_none() && *lods != instance.lods)
}

/// Whether the present levels of a cloth are those of its components.
pub(super) fn present_levels<'a>(
    news: &News,
    cloth: EntityRef<'a>,
) -> Option<(&'a Arc<ClothLevels>, &'a ClothInstance)> {
    let instance = cloth.get::<ClothInstance>()?;
    let levels = instance.levels.as_ref()?;
    (!is_unsettled(news, cloth, instance)).then_some((levels, instance))
}

/// What systems have not seen of a cloth, given whether it wakes in the next tick, and whether its `LodSet` was written.
fn pending(
    world: &World,
    cloth: EntityRef,
    selector: &LevelSelector,
    (wakes, has_new_lods): (bool, bool),
) -> Pending {
    let now = world.read_change_tick();
    let Some(instance) = cloth.get_ref::<ClothInstance>() else { return Pending::default() };
    let last = world.get_resource::<LastAssignment>().map(|last| last.ran).unwrap_or_default();
    let (restored, kept) = match &instance.restored {
        Some(restored) => (restored.at, restored.pending),
        None => Default::default(),
    };
    let changed = instance.last_changed();
    let is_since = |ran: Tick| restored.is_before(changed) && changed.is_newer_than(ran, now);
    Pending {
        levels: wakes || has_new_lods || kept.levels || is_since(selector.ran),
        lanes: wakes || kept.lanes || is_since(last),
    }
}
