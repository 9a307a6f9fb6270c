//! The broad phase: a bounding volume hierarchy of the boxes that colliders sweep in a tick, in the world.
//!
//! Colliders at rest keep their boxes. So a collider costs something only where it moves or where a cloth is near it.

use bevy_ecs::entity::EntityHashMap;
use bevy_ecs::prelude::*;
use bevy_math::Isometry3d;
use parry3d::bounding_volume::{Aabb, BoundingVolume};
use parry3d::partitioning::{Bvh, BvhWorkspace};
use parry3d::shape::SharedShape;

use crate::environment::collider::ClothCollider;
use crate::environment::scaled_shape::ScaledShape;
use crate::motion::pose::{PoseHistory, parry_pose, pose_parts};
use crate::motion::shift::ShiftOrigin;

/// Greatest coordinate of a box in the tree, m: half spaces have larger ones. Larger: they make all other boxes
/// useless. Smaller: colliders far from the origin are near every cloth.
const FARTHEST: f32 = 1e9;

/// The boxes of all colliders in this tick.
#[derive(Resource, Default)]
pub(crate) struct ColliderTree {
    tree: Bvh,
    workspace: BvhWorkspace,
    /// The entity of each leaf; none for a leaf that is free.
    entities: Vec<Option<Entity>>,
    leaves: EntityHashMap<u32>,
    free: Vec<u32>,
    /// Leaves of colliders without end: half spaces, and heightfields, which are solid downwards. Also colliders whose
    /// numbers are not finite.
    endless: Vec<u32>,
    /// Colliders that moved in the last tick.
    moving: Vec<Entity>,
    /// Whether the world was moved, so that all boxes are elsewhere.
    is_shifted: bool,
}

impl ColliderTree {
    /// Whether there are no colliders.
    pub fn is_empty(&self) -> bool {
        self.leaves.is_empty()
    }

    /// The colliders whose boxes intersect a box (m, in the world), in the order of their leaves, which follows from
    /// the order in which colliders came and went.
    pub fn near(&self, cloth: &Aabb) -> impl Iterator<Item = Entity> {
        let endless = self.endless.iter().copied();
        let mut leaves: Vec<u32> = self.tree.intersect_aabb(cloth).chain(endless).collect();
        leaves.sort_unstable();
        leaves.into_iter().filter_map(|leaf| self.entities[leaf as usize])
    }

    /// Stores the box that a collider sweeps in this tick.
    fn set(
        &mut self,
        entity: Entity,
        (collider, shape): (&ClothCollider, &ScaledShape),
        history: &PoseHistory,
    ) {
        let leaf = self.leaf_of(entity);
        match swept_box(collider, shape.of(&collider.shape), history) {
            Some(swept) => {
                self.endless.retain(|&endless| endless != leaf);
                self.tree.insert_or_update_partially(swept, leaf, 0.0);
            }
            None => {
                self.tree.remove(leaf);
                if !self.endless.contains(&leaf) {
                    self.endless.push(leaf);
                }
            }
        }
    }

    /// The colliders in the order of their leaves, none for a leaf that is free; and the free leaves, the last of which is
    /// taken first.
    pub fn order(&self) -> (&[Option<Entity>], &[u32]) {
        (&self.entities, &self.free)
    }

    /// Puts colliders in an order, and those that are not in it behind them. Each gets its box in the next tick.
    pub fn restore(&mut self, order: &[Option<Entity>], free: &[u32]) {
        let known = core::mem::take(&mut self.entities);
        *self = Self::default();
        for (leaf, &entity) in (0..).zip(order) {
            let entity = entity.filter(|entity| !self.leaves.contains_key(entity));
            match entity {
                Some(entity) => _ = self.leaves.insert(entity, leaf),
                None if !free.contains(&leaf) => self.free.push(leaf),
                None => {}
            }
            self.entities.push(entity);
        }
        let is_free = |&&leaf: &&u32| matches!(self.entities.get(leaf as usize), Some(None));
        self.free.extend(free.iter().filter(is_free));
        known.into_iter().flatten().for_each(|entity| _ = self.leaf_of(entity));
        self.moving.extend(self.entities.iter().flatten());
    }

    fn leaf_of(&mut self, entity: Entity) -> u32 {
        *self.leaves.entry(entity).or_insert_with(|| {
            let leaf = self.free.pop().unwrap_or_else(|| {
                self.entities.push(None);
                self.entities.len() as u32 - 1
            });
            self.entities[leaf as usize] = Some(entity);
            leaf
        })
    }

    fn remove(&mut self, entity: Entity) {
        if let Some(leaf) = self.leaves.remove(&entity) {
            self.tree.remove(leaf);
            self.endless.retain(|&endless| endless != leaf);
            self.entities[leaf as usize] = None;
            self.free.push(leaf);
        }
    }
}

/// Box around a collider during a tick, in the world, m; none where the collider has no end. The box includes the
/// margin and the way that particles which the collider pushes may pull others.
fn swept_box(collider: &ClothCollider, shape: &SharedShape, history: &PoseHistory) -> Option<Aabb> {
    if shape.as_heightfield().is_some() {
        return None;
    }
    let (from, to) = history.extrapolated();
    let swept = collider.between(shape, pose_parts(from), pose_parts(to)).swept_box();
    let reach = collider.margin.max(0.0) + from.translation.distance(to.translation);
    let swept = Aabb::new(swept.mins - reach, swept.maxs + reach);
    let farthest = swept.mins.abs().max(swept.maxs.abs()).max_element();
    // False where a number is NaN.
    (farthest <= FARTHEST).then_some(swept)
}

/// The box in the world around a box in a frame, at the start and at the end of a tick.
pub(super) fn in_world(bounds: &Aabb, frame: (Isometry3d, Isometry3d)) -> Aabb {
    let at = |pose: Isometry3d| bounds.transform_by(&parry_pose(pose));
    at(frame.0).merged(&at(frame.1))
}

/// Forgets a collider that is removed or despawned.
pub(super) fn forget_collider(removed: On<Remove, ClothCollider>, mut tree: ResMut<ColliderTree>) {
    tree.remove(removed.entity);
}

/// Makes all boxes anew in the next tick.
pub(super) fn shift_tree(_: On<ShiftOrigin>, mut tree: ResMut<ColliderTree>) {
    tree.is_shifted = true;
}

/// Updates the boxes of colliders that are new, changed or in motion, or moved in the last tick.
pub(super) fn update_tree(
    colliders: Query<(Entity, Ref<ClothCollider>, &ScaledShape, &PoseHistory)>,
    mut tree: ResMut<ColliderTree>,
) {
    if colliders.is_empty() {
        return;
    }
    let tree = &mut *tree;
    let moved = core::mem::take(&mut tree.moving);
    let is_shifted = core::mem::take(&mut tree.is_shifted);
    for (entity, collider, shape, history) in &colliders {
        let moves = !history.rests() || collider.is_changed();
        if moves || is_shifted {
            tree.set(entity, (&collider, shape), history);
        }
        if moves {
            tree.moving.push(entity);
        }
    }
    let mut is_changed = is_shifted || !tree.moving.is_empty();
    for entity in moved {
        if let Ok((entity, collider, shape, history)) = colliders.get(entity)
            && history.rests()
        {
            tree.set(entity, (&collider, shape), history);
            is_changed = true;
        }
    }
    if is_changed {
        tree.tree.refit(&mut tree.workspace);
    }
}
