//! The state of avian's rigid bodies between two ticks.
//!
//! Poses and velocities alone give other bits: contacts begin with the impulses of the last tick, and are solved in the order
//! in which they were found, which depends on the boxes around colliders and on the pairs that overlapped before. All of
//! this is public and can be cloned. The resources and the islands speak of one another: without one of them avian panics.
//! Without `ColliderAabb` or `ColliderTrees` this scene has the same bits; they are saved since they belong to
//! `EnlargedAabb`. Left out is what this scene does not have: joints, bodies that sleep (theirs have `SleepingDisabled`),
//! colliders below their bodies, and bodies that are spawned or despawned.

use avian3d::collider_tree::{ColliderTrees, MovedProxies};
use avian3d::collision::collider::EnlargedAabb;
use avian3d::dynamics::solver::constraint_graph::ConstraintGraph;
use avian3d::dynamics::solver::islands::{BodyIslandNode, PhysicsIslands};
use avian3d::prelude::{
    AngularVelocity, ColliderAabb, ContactGraph, LinearVelocity, Position, RigidBody, Rotation,
};
use bevy::prelude::*;
use bevy_bunting_avian::FormerReaction;

/// What a tick reads of a body and its collider.
#[derive(Clone)]
struct SavedBody {
    entity: Entity,
    transform: Transform,
    position: Position,
    rotation: Rotation,
    linear: LinearVelocity,
    angular: AngularVelocity,
    bounds: ColliderAabb,
    enlarged: EnlargedAabb,
    island: BodyIslandNode,
    /// What cloth did to it, by which the bridge to cloth extrapolates.
    former: Option<FormerReaction>,
}

/// What a tick reads of all bodies.
#[derive(Clone)]
pub struct SavedBodies {
    bodies: Vec<SavedBody>,
    contacts: ContactGraph,
    constraints: ConstraintGraph,
    islands: PhysicsIslands,
    trees: ColliderTrees,
    moved: MovedProxies,
}

/// The components of a [`SavedBody`].
type Body = (
    Entity,
    &'static mut Transform,
    &'static mut Position,
    &'static mut Rotation,
    &'static mut LinearVelocity,
    &'static mut AngularVelocity,
    &'static mut ColliderAabb,
    &'static mut EnlargedAabb,
    &'static mut BodyIslandNode,
    Option<&'static mut FormerReaction>,
);

impl SavedBodies {
    /// The state of all bodies.
    pub fn of(world: &mut World) -> Self {
        let mut bodies = world.query_filtered::<Body, With<RigidBody>>();
        let bodies = bodies.iter(world).map(|body| {
            let (entity, transform, position, rotation, linear, angular, ..) = body;
            let (.., bounds, enlarged, island, former) = body;
            SavedBody {
                entity,
                transform: *transform,
                position: *position,
                rotation: *rotation,
                linear: *linear,
                angular: *angular,
                bounds: *bounds,
                enlarged: *enlarged,
                island: island.clone(),
                former: former.copied(),
            }
        });
        Self {
            bodies: bodies.collect(),
            contacts: world.resource::<ContactGraph>().clone(),
            constraints: world.resource::<ConstraintGraph>().clone(),
            islands: world.resource::<PhysicsIslands>().clone(),
            trees: world.resource::<ColliderTrees>().clone(),
            moved: world.resource::<MovedProxies>().clone(),
        }
    }

    /// Gives all bodies this state.
    ///
    /// Avian takes what is changed between its ticks for moved by hand. So transforms alone count as changed, for what hangs
    /// on the bodies.
    pub fn restore(self, world: &mut World) {
        let mut bodies = world.query::<Body>();
        for saved in self.bodies {
            let Ok(body) = bodies.get_mut(world, saved.entity) else { continue };
            let (_, mut transform, mut position, mut rotation, mut linear, mut angular, ..) = body;
            *transform = saved.transform;
            *position.bypass_change_detection() = saved.position;
            *rotation.bypass_change_detection() = saved.rotation;
            *linear = saved.linear;
            *angular = saved.angular;
            let (.., mut bounds, mut enlarged, mut island, former) = body;
            *bounds = saved.bounds;
            *enlarged = saved.enlarged;
            *island = saved.island;
            if let Some(mut former) = former {
                *former = saved.former.unwrap_or_default();
            }
        }
        world.insert_resource(self.contacts);
        world.insert_resource(self.constraints);
        world.insert_resource(self.islands);
        world.insert_resource(self.trees);
        world.insert_resource(self.moved);
    }
}
