//! [Avian](https://docs.rs/avian3d)'s colliders and rigid bodies for the cloth of [`bevy_bunting`].
//!
//! Add [`ClothAvianPlugin`] besides `PhysicsPlugins` and [`ClothPlugins`](bevy_bunting::ClothPlugins). Every avian
//! [`Collider`](avian3d::prelude::Collider) is then a [`ClothCollider`](bevy_bunting::ClothCollider). A rigid body that
//! cloth shall push and pull gets a [`FeelsCloth`].
//!
//! ```
//! use avian3d::prelude::*;
//! use bevy_app::prelude::*;
//! use bevy_bunting::prelude::*;
//! use bevy_bunting_avian::{ClothAvianPlugin, FeelsCloth};
//! use bevy_time::{TimePlugin, TimeUpdateStrategy};
//! use bevy_transform::prelude::*;
//!
//! let mut app = App::new();
//! app.insert_resource(TimeUpdateStrategy::FixedTimesteps(1))
//!     .add_plugins((TaskPoolPlugin::default(), TimePlugin, TransformPlugin))
//!     .add_plugins((PhysicsPlugins::default(), ClothPlugins::default(), ClothAvianPlugin::default()));
//! # app.finish();
//!
//! // A ball falls past a flag, which it pushes aside and by which it is slowed.
//! app.world_mut().spawn((ClothMesh::grid(33, 23, 1.5, 1.0), Attachment::in_place(ClothEdge::Left)));
//! let ball = (RigidBody::Dynamic, Collider::sphere(0.2), Mass(0.3), FeelsCloth::default());
//! let ball = app.world_mut().spawn((ball, Transform::from_xyz(0.7, 1.0, 0.0))).id();
//! (0..10).for_each(|_| app.update());
//! assert!(app.world().get::<ClothReactions>(ball).is_some());
//! ```
//!
//! # Colliders
//!
//! - **Shapes**: all of avian's that have a surface, with the collider's scale. Meshes of triangles are made as
//!   [`ClothCollider::triangles`](bevy_bunting::ClothCollider::triangles) makes them: solid if closed. Segments and
//!   polylines have no surface, and are reported as [`ClothColliderFailed`].
//! - **Layers**: those of avian's `CollisionLayers`, on colliders and on cloths. They overwrite
//!   [`ClothLayers`](bevy_bunting::ClothLayers).
//! - **Friction**: the dynamic coefficient of the collider's `Friction`, or its body's, or the `DefaultFriction`. A
//!   contact uses the geometric mean of it and the cloth's, whatever avian's rule of combination.
//! - **Margin and features**: none; write [`ClothCollider::margin`](bevy_bunting::ClothCollider::margin) and
//!   [`ClothCollider::features`](bevy_bunting::ClothCollider::features), which are left alone.
//! - Sensors and disabled colliders touch no cloth. A collider that is removed is forgotten. A `ClothCollider` that an
//!   entity has already is left as it is.
//!
//! # Order in a tick
//!
//! In the schedule of both plugins, `FixedPostUpdate` unless [`ClothAvianPlugin::new`] names another:
//!
//! 1. The bodies get the forces of the *last* tick's cloth, at the beginning of avian's `PhysicsSchedule`.
//! 2. Avian moves the bodies, and writes their transforms.
//! 3. [`ClothTick`](bevy_bunting::ClothTick) runs: cloth sees *this* tick's poses of the bodies.
//!
//! A cloth's force thus comes a tick late. What follows from it is told at [`FeelsCloth`].

mod colliders;
mod error;
mod feels;
mod former_reaction;
#[cfg(doctest)]
#[doc = include_str!("../../../docs/guide/avian.md")]
mod guide {}
mod layers;
mod plugin;
mod push;
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}
mod shape;

pub use error::{ClothColliderError, ClothColliderFailed};
pub use feels::FeelsCloth;
pub use former_reaction::FormerReaction;
pub use plugin::ClothAvianPlugin;
