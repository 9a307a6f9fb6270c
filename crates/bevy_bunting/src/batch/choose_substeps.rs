//! Chooses the substeps of each cloth: those that it needs, or more in a batch that it shares with cloths that need more.

use bevy_ecs::prelude::*;
use bunting_solver::{Fabric, LaneCount, StepSettings};

use crate::batch::batches::ClothBatches;
use crate::batch::cost_kind::CostKind;
use crate::batch::shared_substeps::{Member, share};
use crate::cloth::activity::{ClothActivity, ClothPaused};
use crate::cloth::instance::{ClothInstance, has_changed};
use crate::environment::cloth_collision::ClothCollision;
use crate::environment::self_collision::SelfCollision;
use crate::lod::batch_costs::BatchCosts;
use crate::lod::cost_table::CostTable;
use crate::lod::effort::ClothEffort;
use crate::settings::ClothSettings;

/// A cloth that takes substeps unless it is paused or asleep.
pub(crate) type SteppedCloth = (
    Entity,
    &'static mut ClothInstance,
    &'static mut ClothEffort,
    Has<ClothPaused>,
    (Has<SelfCollision>, Has<ClothCollision>),
);

/// Chooses the settings of all cloths in a tick of `tick` seconds. Returns whether any may have changed, or a cloth may
/// need a lane or leave one. `members` is a buffer.
pub(crate) fn choose_substeps(
    cloths: &mut Query<SteppedCloth>,
    settings: &ClothSettings,
    tick: f32,
    all: bool,
    batches: &ClothBatches,
    members: &mut Vec<Member>,
) -> bool {
    let gravity = settings.gravity.length();
    let mut is_due = batches.has_changed();
    for (_, instance, mut effort, paused, _) in &mut *cloths {
        if !has_changed(&instance, |pending| pending.lanes) && !all {
            continue;
        }
        is_due = true;
        let Some(fabric) = instance.fabric().filter(|_| is_stepped(&instance, paused)) else {
            continue;
        };
        // In the units of the fabric.
        let acceleration = effort.class().acceleration(gravity) / instance.growth.end();
        let needed = settings.limits(instance.level).of_fabric(fabric, tick, acceleration);
        let takes = effort.settings.substeps;
        let is_sharing = settings.share_batches && !all && instance.lane().is_some();
        let substeps = if is_sharing { needed.substeps.max(takes) } else { needed.substeps };
        effort.needed = needed;
        effort.settings = StepSettings { substeps, ..needed };
    }
    if is_due && settings.share_batches {
        share_batches(cloths, settings, batches, members);
    }
    is_due
}

/// Lets cloths of one kind share batches where that costs less.
fn share_batches(
    cloths: &mut Query<SteppedCloth>,
    settings: &ClothSettings,
    batches: &ClothBatches,
    members: &mut Vec<Member>,
) {
    members.clear();
    members.extend(cloths.iter().filter_map(|(entity, instance, effort, paused, kept_apart)| {
        let fabric = instance.fabric().filter(|_| is_stepped(instance, paused))?;
        let lane = instance.lane();
        let kind = match lane {
            Some(lane) => batches.kind(lane),
            None => batches.kind_of(fabric, effort.needed)?,
        };
        let touches = match &instance.restored {
            Some(restored) => restored.touches,
            None => lane.is_some_and(|lane| batches.near_colliders(lane).next().is_some()),
        };
        let loads = effort.loads();
        Some(Member {
            entity,
            kind,
            needed: effort.needed.substeps,
            most: most_substeps(settings, instance.level),
            taken: effort.settings.substeps,
            bound: touches || kept_apart.0 || kept_apart.1,
            load: loads.air + loads.frame + loads.motion,
        })
    }));
    keep_differing(members);
    members.sort_unstable_by_key(|member| (member.kind, member.most));
    let alike = |a: &Member, b: &Member| (a.kind, a.most) == (b.kind, b.most);
    for members in members.chunk_by_mut(alike) {
        let Ok((_, instance, effort, ..)) = cloths.get(members[0].entity) else { continue };
        let Some(fabric) = instance.fabric() else { continue };
        share(members, &costs_of_substep(fabric, effort.needed));
        for member in members {
            if let Ok((_, _, mut effort, ..)) = cloths.get_mut(member.entity)
                && effort.settings.substeps != member.taken
            {
                effort.settings.substeps = member.taken;
            }
        }
    }
}

fn is_stepped(instance: &ClothInstance, paused: bool) -> bool {
    !paused && instance.activity == ClothActivity::Ticking
}

/// Most substeps that the limits of a level allow.
fn most_substeps(settings: &ClothSettings, level: usize) -> u32 {
    let limits = settings.steps.get(level).or(settings.steps.last());
    limits.map_or(u32::MAX, |limits| *limits.substeps.end())
}

/// Keeps the cloths of kinds in which not all need and take the same number of substeps.
fn keep_differing(members: &mut Vec<Member>) {
    let kinds = members.iter().map(|member| member.kind + 1).max().unwrap_or(0);
    let mut spans = vec![[u32::MAX, 0]; kinds];
    for &Member { kind, needed, taken, .. } in &*members {
        let [least, most] = &mut spans[kind];
        *least = needed.min(*least);
        *most = taken.max(*most);
    }
    members.retain(|member| spans[member.kind][0] < spans[member.kind][1]);
}

/// Cost of a batch of sixteen lanes over that of one of eight: the least that was measured. Smaller: machines with eight lanes
/// share batches that cost them more than two that are full. Larger: machines with sixteen lanes do not share batches that would
/// cost them less.
const SIXTEEN_OVER_EIGHT: f32 = 1.5;

/// Costs of a substep of batches of a fabric. They are the same on every machine, whatever its width, so that the same cloths
/// share batches.
fn costs_of_substep(fabric: &Fabric, settings: StepSettings) -> BatchCosts {
    let of = |lanes: LaneCount| {
        CostTable::default().batch(CostKind {
            particles: fabric.particle_count(),
            settings: StepSettings { substeps: 1, ..settings },
            lanes,
            mixed: false,
        })
    };
    let eight = of(LaneCount::Eight);
    BatchCosts {
        one: of(LaneCount::One),
        eight,
        sixteen: Some(SIXTEEN_OVER_EIGHT * eight),
        most_single: LaneCount::most_alone(fabric, settings.scheme) as u32,
        ..BatchCosts::default()
    }
}
