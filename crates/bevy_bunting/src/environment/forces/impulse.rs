//! Impulses: a change of velocity around a place.

use bevy_ecs::prelude::*;
use bevy_math::{Isometry3d, Vec3};
use bunting_solver::ClothSnapshot;

use crate::batch::batches::ClothBatches;
use crate::cloth::error::ClothError;
use crate::cloth::events::ClothFailed;
use crate::cloth::instance::{ClothInstance, StateStorage};
use crate::environment::falloff::falloff;
use crate::lod::rest_timer::RestTimer;
use crate::motion::pose::PoseHistory;
use crate::motion::shift::ShiftOrigin;

/// A change of the velocity of all cloth around a place, or of one cloth. Trigger it anywhere; it acts at the beginning of
/// the next tick, and wakes cloths that sleep at rest. Pinned particles are not moved.
///
/// ```
/// # use bevy_ecs::prelude::*;
/// # use bevy_math::Vec3;
/// # use bevy_bunting::prelude::*;
/// # fn hit(mut commands: Commands, flag: Entity) {
/// commands.trigger(ClothImpulse::velocity(Vec3::Y, 2.0, 5.0 * Vec3::X));
/// commands.trigger(ClothImpulse::momentum(Vec3::Y, 0.3, 0.2 * Vec3::X).on(flag));
/// # }
/// ```
///
/// An impulse that is not finite, or has a radius that is not positive, is reported as [`ClothError::Impulse`] for its
/// cloth, or logged if it is for all, and has no effect.
#[derive(Event, Clone, Copy, Debug, PartialEq)]
pub struct ClothImpulse {
    /// The cloth that it is for; none: every cloth.
    pub cloth: Option<Entity>,
    /// The place in the world, m.
    pub at: Vec3,
    /// Distance from the place within which particles are pushed, m. An infinite one pushes all alike.
    pub radius: f32,
    /// Distance inside this radius over which the push falls to zero, m. Zero or less: a sharp border.
    pub falloff: f32,
    /// What the particles are given.
    pub push: Push,
}

/// What a [`ClothImpulse`] gives to the particles around its place, along the world's axes.
///
/// ```
/// use bevy_bunting::Push;
/// use bevy_math::Vec3;
///
/// // A gust throws all cloth alike; a ball throws light cloth farther.
/// let [gust, ball] = [Push::Velocity(3.0 * Vec3::X), Push::Momentum(0.5 * Vec3::X)];
/// # assert_ne!(gust, ball);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Push {
    /// A change of velocity, m/s, before the falloff.
    Velocity(Vec3),
    /// A momentum, kg m/s, which all pushed particles share: the changes of their velocities have the ratios of the
    /// falloff.
    Momentum(Vec3),
}

impl ClothImpulse {
    /// A change of velocity (m/s) of all cloth around a place (m), which falls to zero at a distance (m).
    #[must_use]
    pub const fn velocity(at: Vec3, radius: f32, change: Vec3) -> Self {
        Self { cloth: None, at, radius, falloff: radius, push: Push::Velocity(change) }
    }

    /// A momentum (kg m/s) that all cloth around a place (m) shares, which falls to zero at a distance (m).
    #[must_use]
    pub const fn momentum(at: Vec3, radius: f32, momentum: Vec3) -> Self {
        Self { cloth: None, at, radius, falloff: radius, push: Push::Momentum(momentum) }
    }

    /// The impulse for one cloth only.
    #[must_use]
    pub const fn on(mut self, cloth: Entity) -> Self {
        self.cloth = Some(cloth);
        self
    }

    /// The impulse with a falloff (m).
    #[must_use]
    pub const fn with_falloff(mut self, falloff: f32) -> Self {
        self.falloff = falloff;
        self
    }

    fn is_valid(&self) -> bool {
        let (Push::Velocity(push) | Push::Momentum(push)) = self.push;
        push.is_finite() && self.at.is_finite() && self.radius > 0.0
    }
}

/// The impulses that act in the next tick.
#[derive(Resource, Debug, Default)]
pub(super) struct Impulses(Vec<ClothImpulse>);

/// Queues an impulse, since a substep may be going on.
pub(super) fn queue_impulse(
    impulse: On<ClothImpulse>,
    mut impulses: ResMut<Impulses>,
    mut commands: Commands,
) {
    let impulse = *impulse.event();
    match impulse.cloth {
        _ if impulse.is_valid() => impulses.0.push(impulse),
        Some(entity) => {
            ClothFailed::report(&mut commands, entity, ClothError::Impulse { entity });
        }
        None => log::error!("a ClothImpulse must be finite, with a positive radius: {impulse:?}"),
    }
}

/// Moves the places of queued impulses along with the world.
pub(super) fn shift_impulses(shift: On<ShiftOrigin>, mut impulses: ResMut<Impulses>) {
    impulses.0.iter_mut().for_each(|impulse| impulse.at += shift.acting());
}

type PushedCloth =
    (Entity, &'static mut ClothInstance, &'static PoseHistory, &'static mut RestTimer);

pub(super) fn apply_impulses(
    mut impulses: ResMut<Impulses>,
    mut cloths: Query<PushedCloth>,
    mut batches: ResMut<ClothBatches>,
    mut commands: Commands,
) {
    if impulses.0.is_empty() {
        return;
    }
    for impulse in impulses.0.drain(..) {
        let is_meant = |entity| impulse.cloth.is_none_or(|cloth| cloth == entity);
        let mut pushed = Vec::new();
        for (entity, instance, history, _) in cloths.iter().filter(|cloth| is_meant(cloth.0)) {
            pushed.extend(Reached::new(&impulse, entity, instance, history.start(), &batches));
        }
        let mass: f64 = pushed.iter().map(|cloth| cloth.weighted_mass).sum();
        let change = match impulse.push {
            Push::Velocity(change) => change,
            Push::Momentum(momentum) => (momentum.as_dvec3() / mass).as_vec3(),
        };
        for cloth in pushed {
            let entity = cloth.entity;
            let Ok((_, mut instance, _, mut timer)) = cloths.get_mut(entity) else { continue };
            let Some(mut state) = instance.state(&batches) else { continue };
            cloth.push(&mut state, change);
            if state.is_finite() {
                instance.set_state(state, &mut batches);
                timer.restart();
            } else {
                ClothFailed::report(&mut commands, entity, ClothError::Impulse { entity });
            }
        }
    }
}

/// The particles of a cloth that an impulse reaches.
struct Reached {
    entity: Entity,
    /// Pose of the cloth's frame.
    frame: Isometry3d,
    /// Metres in a unit of the frame.
    size: f32,
    /// Particles, and their parts of the change of velocity.
    weights: Vec<(usize, f32)>,
    /// Sum of masses times these parts, kg.
    weighted_mass: f64,
}

impl Reached {
    fn new(
        impulse: &ClothImpulse,
        entity: Entity,
        instance: &ClothInstance,
        frame: Isometry3d,
        batches: &ClothBatches,
    ) -> Option<Self> {
        let fabric = instance.fabric()?;
        let mut in_lane = Vec::new();
        let positions = match &instance.storage {
            StateStorage::None => return None,
            StateStorage::Snapshot(snapshot) => &snapshot.positions,
            StateStorage::Lane(lane) => {
                batches.batch(*lane).copy_positions(lane.lane, &mut in_lane);
                &in_lane
            }
        };
        let size = instance.growth.end();
        let weight = |position: &Vec3| {
            let at = frame * (size * *position);
            falloff(impulse.radius - impulse.at.distance(at), impulse.falloff)
        };
        let free =
            positions.iter().enumerate().filter(|(particle, _)| !fabric.is_pinned(*particle));
        let weights = free.map(|(particle, position)| (particle, weight(position)));
        let weights: Vec<_> = weights.filter(|(_, weight)| *weight > 0.0).collect();
        let density = f64::from(instance.material.area_density * size * size);
        let mass = |&(particle, weight): &(usize, f32)| {
            density * f64::from(fabric.particle_areas()[particle]) * f64::from(weight)
        };
        let weighted_mass = weights.iter().map(mass).sum();
        (!weights.is_empty()).then_some(Self { entity, frame, size, weights, weighted_mass })
    }

    /// Changes the velocities of the particles, by `change` (m/s, along the world's axes) times their parts.
    fn push(&self, state: &mut ClothSnapshot, change: Vec3) {
        let change = self.frame.rotation.inverse() * change / self.size;
        for &(particle, weight) in &self.weights {
            state.add_velocity(particle, weight * change);
        }
    }
}
