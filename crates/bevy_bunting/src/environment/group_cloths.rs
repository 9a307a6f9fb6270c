//! Finds the cloths that may touch one another in a tick.

use bevy_app::{App, Plugin};
use bevy_ecs::entity::EntityHashSet;
use bevy_ecs::prelude::*;
use bevy_ecs::query::QueryData;
use bevy_math::Vec3;
use bevy_time::Time;
use bunting_solver::GroupMember;
use parry3d::bounding_volume::{Aabb, BoundingVolume};

use crate::batch::batches::ClothBatches;
use crate::batch::touching::TouchingCloth;
use crate::cloth::activity::ClothActivity;
use crate::cloth::error::ClothError;
use crate::cloth::events::ClothFailed;
use crate::cloth::instance::ClothInstance;
use crate::cloth::state::ClothState;
use crate::environment::cloth_collision::ClothCollision;
use crate::environment::collider_tree::in_world;
use crate::environment::drive::drive_cloths;
use crate::environment::drive_colliders::drive_colliders;
use crate::environment::drive_self_collisions::drive_self_collisions;
use crate::environment::layers::ClothLayers;
use crate::lod::record::LodRecord;
use crate::lod::rest_timer::RestTimer;
use crate::motion::inertia::ClothInertia;
use crate::motion::pose::{PoseHistory, pose_parts};
use crate::schedule::{ClothSystems, ClothTick};

/// Distance by which the box around a cloth's paths is widened, m, since a cloth that another one pushes goes farther than
/// by itself. Smaller: pushed cloth enters a third one. Larger: cloths are solved together that do not touch.
const REACH: f32 = 0.05;

/// Distance from a sleeping cloth within which a moving one wakes it, m. Smaller: fast cloth enters sleeping cloth.
const CLEARANCE: f32 = 0.5;

/// Part by which the sizes of cloths that touch one another may differ, of which the solver takes one. Smaller: garments of one
/// growing figure pass through one another by rounding. Larger: distances between them are visibly wrong.
const SAME_SIZE: f32 = 1e-3;

/// Keeps cloths with a [`ClothCollision`] from passing through one another.
#[derive(Debug, Default)]
pub struct ClothCollisionPlugin;

impl Plugin for ClothCollisionPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<ClothCollision>().add_systems(
            ClothTick,
            (
                report_bad_thickness.in_set(ClothSystems::Prepare),
                group_cloths
                    .in_set(ClothSystems::Drive)
                    .after(drive_cloths)
                    .after(drive_colliders)
                    .after(drive_self_collisions),
            ),
        );
    }
}

/// Reports new and changed components that the solver refuses.
fn report_bad_thickness(
    cloths: Query<(Entity, &ClothCollision), Changed<ClothCollision>>,
    mut commands: Commands,
) {
    for (entity, collision) in &cloths {
        if !collision.is_valid() {
            ClothFailed::report(&mut commands, entity, ClothError::Collision { entity });
        }
    }
}

/// A cloth that may touch others.
#[derive(QueryData)]
#[query_data(mutable)]
struct CollidingCloth {
    entity: Entity,
    instance: &'static mut ClothInstance,
    collision: &'static ClothCollision,
    frame: &'static PoseHistory,
    state: &'static ClothState,
    record: &'static LodRecord,
    timer: &'static mut RestTimer,
    layers: Option<&'static ClothLayers>,
    inertia: Option<&'static ClothInertia>,
}

/// A cloth in a lane that may touch others.
struct Awake {
    entity: Entity,
    cloth: TouchingCloth,
    layers: ClothLayers,
    /// Box around its paths in this tick, in the world, m.
    around: Aabb,
    is_moving: bool,
    /// Metres in a unit of the frame.
    size: f32,
    /// Index of the first cloth of its group.
    group: usize,
}

/// Groups the cloths in lanes whose paths come near one another, and wakes those that a moving one is near.
fn group_cloths(
    mut cloths: Query<CollidingCloth>,
    time: Res<Time>,
    mut batches: ResMut<ClothBatches>,
    mut reported: Local<EntityHashSet>,
    mut commands: Commands,
) {
    let mut awake = Vec::new();
    if cloths.iter().len() > 1 {
        let tick = time.delta_secs();
        let lanes: Vec<_> = cloths.iter().filter_map(|cloth| cloth.instance.lane()).collect();
        batches.update_bounds_of(&lanes, tick);
        awake.extend(cloths.iter().filter_map(|cloth| cloth.awake(&batches, tick)));
        awake.sort_unstable_by_key(|cloth: &Awake| cloth.entity);
        for [one, other] in unite(&mut awake) {
            if reported.insert(one) {
                let error = ClothError::CollisionScale { entity: one, other };
                ClothFailed::report(&mut commands, one, error);
            }
        }
        for index in 0..awake.len() {
            let size = awake[awake[index].group].size;
            awake[index].cloth.member.start.0 /= size;
        }
    } else {
        reported.clear();
    }
    for mut cloth in &mut cloths {
        let found = awake.binary_search_by_key(&cloth.entity, |awake| awake.entity);
        cloth.timer.group = found.ok().map(|at| awake[awake[at].group].entity);
        if cloth.instance.activity == ClothActivity::AtRest && cloth.is_disturbed(&awake) {
            cloth.timer.restart();
            cloth.instance.wake();
        }
    }
    let groups = (0..awake.len()).filter(|&index| awake[index].group == index).map(|first| {
        let members = awake.iter().filter(|cloth| cloth.group == first);
        members.map(|cloth| cloth.cloth).collect()
    });
    let groups: Vec<Vec<TouchingCloth>> = groups.filter(|it: &Vec<_>| it.len() > 1).collect();
    batches.set_touching(&groups);
}

impl CollidingClothReadOnlyItem<'_, '_> {
    /// The cloth, if it is in a lane and touches others at its level.
    fn awake(&self, batches: &ClothBatches, tick: f32) -> Option<Awake> {
        let ClothCollision { thickness, levels } = *self.collision;
        let lane = self.instance.lane()?;
        if !self.collision.is_valid() || self.instance.level >= levels {
            return None;
        }
        let frame = (self.frame.start(), self.frame.end());
        let growth = &self.instance.growth;
        let around = growth.bounds(&batches.bounds(lane)?);
        let around = in_world(&around, frame).loosened(thickness + REACH);
        let layers = self.layers.copied().unwrap_or_default();
        let motion = growth.motion(self.frame.motion());
        let inertia = self.inertia.map_or_else(ClothInertia::default, |it| it.acting());
        let inertia = growth.inertia(inertia);
        let start = pose_parts(frame.0);
        let carrier = inertia.carrier(self.instance.rest_middle, &motion, tick);
        let member = GroupMember {
            thickness: thickness / growth.end(),
            memberships: layers.memberships,
            filters: layers.filters,
            // In m, until the size of the group is known.
            start,
            motion,
            carrier: frame.1.rotation * carrier,
        };
        Some(Awake {
            entity: self.entity,
            cloth: TouchingCloth { lane, member },
            layers,
            around,
            is_moving: self.timer.ticks == 0,
            size: growth.end(),
            group: 0,
        })
    }
}

impl CollidingClothItem<'_, '_> {
    /// Whether a moving cloth is near.
    fn is_disturbed(&self, awake: &[Awake]) -> bool {
        let middle = self.state.positions().get(self.state.positions().len() / 2);
        let size = self.instance.growth.end();
        let middle: Vec3 = self.frame.end() * (size * middle.copied().unwrap_or_default());
        let layers = self.layers.copied().unwrap_or_default();
        let reach = size * self.record.radius + CLEARANCE;
        awake.iter().any(|other| {
            let nearest = middle.clamp(other.around.mins, other.around.maxs);
            other.is_moving
                && layers.touch(other.layers)
                && nearest.distance_squared(middle) < reach * reach
        })
    }
}

/// Unites cloths whose boxes intersect: those of a group have the index of its first cloth. Returns pairs that are not united
/// since they have grown by different factors.
fn unite(cloths: &mut [Awake]) -> Vec<[Entity; 2]> {
    let mut of_other_size = Vec::new();
    (0..cloths.len()).for_each(|index| cloths[index].group = index);
    let mut by_start: Vec<usize> = (0..cloths.len()).collect();
    by_start
        .sort_by(|&one, &other| cloths[one].around.mins.x.total_cmp(&cloths[other].around.mins.x));
    for (rank, &one) in by_start.iter().enumerate() {
        for &other in &by_start[rank + 1..] {
            let [first, second] = [&cloths[one], &cloths[other]];
            if second.around.mins.x > first.around.maxs.x {
                break;
            }
            if first.layers.touch(second.layers) && first.around.intersects(&second.around) {
                if (first.size - second.size).abs() > SAME_SIZE * first.size {
                    of_other_size.push([first.entity, second.entity]);
                    continue;
                }
                let roots = [root(cloths, one), root(cloths, other)];
                cloths[roots[0].max(roots[1])].group = roots[0].min(roots[1]);
            }
        }
    }
    // A cloth's group has a smaller index, so that it is final before the cloth's own.
    for index in 0..cloths.len() {
        cloths[index].group = cloths[cloths[index].group].group;
    }
    of_other_size
}

/// Index of the first cloth of a group so far.
fn root(cloths: &[Awake], mut index: usize) -> usize {
    while cloths[index].group != index {
        index = cloths[index].group;
    }
    index
}
