//! Cloth that is grabbed at run time.

use std::collections::HashSet;
use std::sync::Arc;

use bevy_ecs::entity::EntityMapper;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_reflect::Reflect;
use bevy_transform::components::Transform;

use crate::fabric::known_level::KnownLevel;
use crate::fabric::levels::ClothLevels;
use crate::motion::anchor_hold::infinite_force;
use crate::motion::held_group::HeldGroup;
use crate::motion::pose::PoseHistory;

/// Stiffness with which a hand grabs unless another is given, N/m.
const STIFFNESS: f32 = 200.0;

/// Distance at rest within which particles of two levels are the same vertex, m.
const SHARED: f32 = 1e-4;

/// Holds vertices of a cloth where they are now, relative to the entity with this component: a hand, a hook, a cursor.
///
/// Insert it to grab and remove it (or despawn the entity) to let go: neither makes the cloth jump, and no fabric is built.
/// The vertices are chosen in the first tick in which the cloth is simulated and any is within reach; another level holds those of them that it
/// has. Changing the component grabs anew. Vertices that the cloth's attachment pins are not grabbed.
///
/// ```
/// use bevy_bunting::prelude::*;
/// use bevy_ecs::prelude::*;
/// use bevy_transform::prelude::*;
///
/// let mut world = World::new();
/// let cloth = world.spawn(ClothMesh::grid(17, 17, 1.0, 1.0)).id();
/// // A hand that holds what is within 10 cm of it, with at most 30 N.
/// let grab = ClothGrab::within(cloth, 0.1).with_strength(200.0, 30.0);
/// let hand = world.spawn((grab, Transform::from_xyz(0.5, 0.0, 0.0))).id();
/// world.entity_mut(hand).remove::<ClothGrab>();
/// ```
#[derive(Component, Clone, Debug, Reflect)]
#[type_path = "bevy_bunting"]
#[component(map_entities = map_cloth)]
#[reflect(Component, Debug, Clone)]
#[require(Transform, PoseHistory, Grabbed)]
pub struct ClothGrab {
    /// The cloth.
    pub cloth: Entity,
    /// The vertices that are held.
    pub vertices: GrabbedVertices,
    /// Stiffness of the hold, N/m, of all vertices together.
    #[reflect(default = "stiffness")]
    pub stiffness: f32,
    /// Greatest force, N, of all vertices together: cloth that pulls harder is drawn along no further. May be infinite.
    #[reflect(default = "infinite_force")]
    pub max_force: f32,
}

/// The vertices that a [`ClothGrab`] holds.
///
/// ```
/// use bevy_bunting::prelude::*;
/// use bevy_ecs::prelude::*;
///
/// let mut world = World::new();
/// let cloth = world.spawn(ClothMesh::grid(17, 17, 1.0, 1.0)).id();
/// // The lower left corner, wherever the hand is.
/// let corner = GrabbedVertices::List(vec![16 * 17]);
/// world.spawn(ClothGrab::new(cloth, corner));
/// ```
#[derive(Clone, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Debug, PartialEq, Clone)]
pub enum GrabbedVertices {
    /// Vertices of the [`ClothMesh`](crate::ClothMesh) by index, and what lies between them. A coarser level of a grid holds those
    /// that it has.
    List(Vec<u32>),
    /// All vertices in a ball.
    Ball {
        /// Centre in the frame of the entity, m.
        centre: Vec3,
        /// Radius, m.
        radius: f32,
    },
}

/// Stiffness of a grab in a file that names none, N/m.
fn stiffness() -> f32 {
    STIFFNESS
}

impl ClothGrab {
    /// Holds vertices of a cloth by a stiffness of 200 N/m, without a greatest force.
    #[must_use]
    pub fn new(cloth: Entity, vertices: GrabbedVertices) -> Self {
        Self { cloth, vertices, stiffness: STIFFNESS, max_force: f32::INFINITY }
    }

    /// Holds the vertices within a distance (m) of the entity.
    #[must_use]
    pub fn within(cloth: Entity, radius: f32) -> Self {
        Self::new(cloth, GrabbedVertices::Ball { centre: Vec3::ZERO, radius })
    }

    /// The grab with another stiffness (N/m) and greatest force (N).
    #[must_use]
    pub fn with_strength(mut self, stiffness: f32, max_force: f32) -> Self {
        (self.stiffness, self.max_force) = (stiffness, max_force);
        self
    }

    /// Whether all numbers can be used.
    pub(crate) fn is_valid(&self) -> bool {
        let of_ball = match &self.vertices {
            GrabbedVertices::List(_) => true,
            GrabbedVertices::Ball { centre, radius } => centre.is_finite() && *radius >= 0.0,
        };
        of_ball && self.stiffness.is_finite() && self.stiffness > 0.0 && self.max_force >= 0.0
    }
}

/// Maps the cloth when a scene is loaded.
fn map_cloth<M: EntityMapper>(grab: &mut ClothGrab, mapper: &mut M) {
    grab.cloth = mapper.get_mapped(grab.cloth);
}

/// What a [`ClothGrab`] holds, and how hard the cloth pulls.
#[derive(Component, Clone, Debug, Default)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct Grabbed {
    /// The levels and the level of the particles.
    #[cfg_attr(feature = "serialize", serde(skip))]
    of: Option<KnownLevel>,
    /// Positions at rest of the particles that were grabbed, and their places in the frame of the entity, m.
    grabbed: Vec<(Vec3, Vec3)>,
    /// The particles that are held at the present level, and their places in the frame of the entity, m.
    pub(crate) held: Vec<(u32, Vec3)>,
    /// Mean force of the cloth in the last tick, N, in the world.
    pub(crate) force: Vec3,
}

impl Grabbed {
    /// Mean force of the cloth on the entity in the last tick, N, in the world.
    #[must_use]
    pub fn force(&self) -> Vec3 {
        self.force
    }

    /// Number of particles that are held.
    #[must_use]
    pub fn count(&self) -> usize {
        self.held.len()
    }

    /// Whether nothing was grabbed yet.
    pub(crate) fn is_new(&self) -> bool {
        self.grabbed.is_empty()
    }

    /// Whether the particles are those of a level.
    pub(crate) fn fits(&self, levels: &Arc<ClothLevels>, level: usize) -> bool {
        self.of.as_ref().is_some_and(|of| of.is(levels, level))
    }

    /// What was saved of a grab of a cloth at this level; nothing is held that the level does not have.
    pub(crate) fn restored(mut self, levels: &Arc<ClothLevels>, level: usize) -> Self {
        let count = levels.fabric(level).particle_count();
        self.held.retain(|&(particle, _)| (particle as usize) < count);
        self.of = Some(KnownLevel::new(levels, level));
        self
    }

    /// Grabs: chooses the particles at the present level, given the places of all particles in the frame of the entity, m.
    pub(crate) fn grab(
        &mut self,
        grab: &ClothGrab,
        levels: &Arc<ClothLevels>,
        level: usize,
        places: &[Vec3],
    ) {
        let fabric = levels.fabric(level);
        let is_chosen: Box<dyn Fn(usize) -> bool> = match &grab.vertices {
            GrabbedVertices::List(vertices) => {
                let held = levels.held(level, &[HeldGroup::of_vertices(vertices.clone())]);
                let particles: HashSet<usize> = held.iter().map(|it| it.particle).collect();
                Box::new(move |particle| particles.contains(&particle))
            }
            GrabbedVertices::Ball { centre, radius } => {
                Box::new(move |particle| places[particle].distance(*centre) <= *radius)
            }
        };
        let free = (0..places.len()).filter(|&particle| !fabric.is_pinned(particle));
        let chosen = free.filter(|&particle| is_chosen(particle));
        self.held = chosen.map(|at| (at as u32, places[at])).collect();
        let rest = fabric.rest_positions();
        let at_rest = |&(at, place): &(u32, Vec3)| (rest[at as usize], place);
        self.grabbed = self.held.iter().map(at_rest).collect();
        self.of = Some(KnownLevel::new(levels, level));
    }

    /// Chooses the particles at another level that were grabbed, and holds them at their places; if it has none of them, those
    /// that are nearest at rest, where they are.
    pub(crate) fn change_level(
        &mut self,
        levels: &Arc<ClothLevels>,
        level: usize,
        places: &[Vec3],
    ) {
        let fabric = levels.fabric(level);
        let rest = fabric.rest_positions();
        let free = (0..rest.len()).filter(|&particle| !fabric.is_pinned(particle));
        let nearest = |to: Vec3| {
            let distance = |&at: &usize| rest[at].distance_squared(to);
            free.clone().min_by(|one, other| distance(one).total_cmp(&distance(other)))
        };
        let shared = self.grabbed.iter().filter_map(|&(at_rest, place)| {
            let particle = nearest(at_rest)?;
            (rest[particle].distance(at_rest) < SHARED).then_some((particle as u32, place))
        });
        self.held = shared.collect();
        if self.held.is_empty() {
            let nearest = self.grabbed.iter().filter_map(|&(at_rest, _)| nearest(at_rest));
            self.held.extend(nearest.map(|at| (at as u32, places[at])));
            self.held.sort_unstable_by_key(|held| held.0);
            self.held.dedup_by_key(|held| held.0);
        }
        self.of = Some(KnownLevel::new(levels, level));
    }
}
