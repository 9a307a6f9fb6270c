//! The animated places of a cloth's particles, by linear blend skinning.

use std::sync::Arc;

use bevy_ecs::prelude::*;
use bevy_math::{Affine3A, Vec3};
use bunting_solver::{Guide, MovingPin};

use crate::fabric::known_level::KnownLevel;
use crate::fabric::levels::ClothLevels;
use crate::skeleton::skinned_particle::{Place, SkinnedParticle};
use crate::skeleton::vertex_skins::VertexSkins;

/// The particles of a skinned cloth at its present level, and their places.
#[derive(Component, Debug, Default)]
pub(crate) struct SkinnedParticles {
    /// The last valid skin and limits.
    skins: VertexSkins,
    /// The levels and the level that the particles are those of.
    of: Option<KnownLevel>,
    particles: Vec<SkinnedParticle>,
    /// The pinned particles.
    pins: Vec<u32>,
    has_limits: bool,
    /// Places at the start and at the end of the tick, each in the cloth's frame at that time.
    places: [Vec<Place>; 2],
    /// Skinning matrices of the places at the end of the tick; none before the first.
    matrices: Option<Vec<Affine3A>>,
}

impl SkinnedParticles {
    /// The particles of a cloth with a valid skin and its limits, which are found in the next tick.
    pub fn of(skins: VertexSkins) -> Self {
        Self { skins, ..Self::default() }
    }

    /// Whether the particles are those of a level.
    pub fn fits(&self, levels: &Arc<ClothLevels>, level: usize) -> bool {
        self.of.as_ref().is_some_and(|of| of.is(levels, level))
    }

    /// Finds the particles anew in the next tick.
    pub fn forget(&mut self) {
        self.of = None;
    }

    /// The last valid skin and limits.
    pub fn skins(&self) -> &VertexSkins {
        &self.skins
    }

    /// Takes over another valid skin and its limits. The particles are found anew in the next tick.
    pub fn set_skins(&mut self, skins: VertexSkins) {
        self.skins = skins;
        self.forget();
    }

    /// Takes the limits of all particles.
    pub fn free(&mut self) {
        self.skins.limits = None;
        self.forget();
    }

    /// Finds the particles of a level.
    pub fn find(&mut self, levels: &Arc<ClothLevels>, level: usize) {
        let fabric = levels.fabric(level);
        let at_rest = fabric.rest_positions().iter().enumerate();
        self.particles.clear();
        self.particles.extend(at_rest.map(|(particle, &rest)| SkinnedParticle {
            rest,
            ..self.skins.particle(levels.corners(level, particle))
        }));
        self.of = Some(KnownLevel::new(levels, level));
        let pins = (0..self.particles.len()).filter(|&particle| fabric.is_pinned(particle));
        self.pins = pins.map(|particle| particle as u32).collect();
        let is_limited = |particle: &SkinnedParticle| {
            particle.max_distance < f32::INFINITY || particle.backstop.radius > 0.0
        };
        self.has_limits = self.particles.iter().any(is_limited);
    }

    /// Skinning matrices of the places at the end of the last tick; none before the first.
    pub fn matrices(&self) -> Option<&[Affine3A]> {
        self.matrices.as_deref()
    }

    /// Takes over the matrices of a saved cloth, whose places in its last tick follow from those of its joints then.
    pub fn restore(
        &mut self,
        levels: &Arc<ClothLevels>,
        level: usize,
        matrices: Option<Vec<Affine3A>>,
        [start, end]: [Vec<Affine3A>; 2],
    ) {
        self.find(levels, level);
        self.begin_at(&start);
        self.end_at(end);
        self.matrices = matrices;
        self.forget();
    }

    /// Begins a tick whose places at the start are those of the end of the last one.
    pub fn go_on(&mut self) {
        self.places.swap(0, 1);
    }

    /// Begins a tick whose places at the start are those of the given skinning matrices.
    pub fn begin_at(&mut self, matrices: &[Affine3A]) {
        self.places[0].clear();
        self.places[0].extend(self.particles.iter().map(|particle| particle.place(matrices)));
    }

    /// Finds the places at the end of the tick.
    pub fn end_at(&mut self, matrices: Vec<Affine3A>) {
        self.places[1].clear();
        self.places[1].extend(self.particles.iter().map(|particle| particle.place(&matrices)));
        self.matrices = Some(matrices);
    }

    /// Moves positions (m) along with the skin, from one pose, or from rest, to another.
    pub fn carry(&self, positions: &mut [Vec3], from: Option<&[Affine3A]>, to: &[Affine3A]) {
        for (position, particle) in positions.iter_mut().zip(&self.particles) {
            let before = from.map_or(Affine3A::IDENTITY, |from| particle.matrix(from));
            let after = particle.matrix(to);
            let bound = before.inverse().transform_point3(*position);
            let moved = after.transform_point3(bound);
            // The blend of two opposite turns has no inverse.
            *position = if moved.is_finite() { moved } else { particle.place(to).position };
        }
    }

    /// Whether all pins are in their places at the start of the tick, to within a distance in m.
    pub fn are_pins_in_place(&self, positions: &[Vec3], tolerance: f32) -> bool {
        self.pins.iter().all(|&pin| {
            let pin = pin as usize;
            positions[pin].distance(self.places[0][pin].position) < tolerance
        })
    }

    /// Place of a particle at the end of the tick, m.
    pub fn place(&self, particle: u32) -> Vec3 {
        self.places[1][particle as usize].position
    }

    /// The motions of the pins in this tick.
    pub fn motions(&self) -> Vec<MovingPin> {
        let [from, to] = &self.places;
        let motion = |&particle: &u32| MovingPin {
            particle,
            from: from[particle as usize].position,
            to: to[particle as usize].position,
        };
        self.pins.iter().map(motion).filter(|pin| pin.from != pin.to).collect()
    }

    /// The guides of all particles in this tick; empty if there is no limit.
    pub fn guides(&self) -> Vec<Guide> {
        if !self.has_limits {
            return Vec::new();
        }
        let [from, to] = &self.places;
        let places = self.particles.iter().zip(from).zip(to);
        let guides = places.map(|((particle, from), to)| Guide {
            places: [from.position, to.position],
            normals: [from.normal, to.normal],
            max_distance: particle.max_distance,
            backstop: particle.backstop,
        });
        guides.collect()
    }

    /// Blends simulated positions (m) and normals of a level's particles with their places at the end of the tick.
    pub fn blend(&self, level: usize, positions: &mut [Vec3], normals: &mut [Vec3]) {
        if self.of.as_ref().is_none_or(|of| !of.has_number(level)) {
            return;
        }
        let shown = positions.iter_mut().zip(normals);
        let particles = self.particles.iter().zip(&self.places[1]);
        for ((position, normal), (particle, place)) in shown.zip(particles) {
            if particle.simulated < 1.0 {
                *position = place.position.lerp(*position, particle.simulated);
                *normal = place.normal.lerp(*normal, particle.simulated).normalize_or_zero();
            }
        }
    }

    /// Moves positions (m) that are shown at a fraction of the tick along with the skin to a pose.
    pub fn show(&self, level: usize, fraction: f32, pose: &[Affine3A], shown: &mut [Vec3]) {
        let [from, to] = &self.places;
        if self.of.as_ref().is_none_or(|of| !of.has_number(level)) || to.len() != shown.len() {
            return;
        }
        for (index, (position, particle)) in shown.iter_mut().zip(&self.particles).enumerate() {
            let place = from[index].position.lerp(to[index].position, fraction);
            *position += particle.place(pose).position - place;
        }
    }
}
