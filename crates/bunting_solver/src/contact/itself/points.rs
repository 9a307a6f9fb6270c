//! Particles that touch, as vectors that are gathered into lanes.

use glam::{Vec3, Vec3A, Vec4};

use crate::contact::itself::particles::Particles;
use crate::simd::lane::{Lane, Pack};
use crate::simd::registers::{Pack4, Pack8};
use crate::simd::vec3::V3;

/// Particles that touch, as vectors that are gathered into lanes.
#[derive(Clone, Debug, Default)]
pub(in crate::contact) struct Points {
    /// Positions at the start of the substep, m.
    pub start: Vec<Pack4>,
    /// Positions, corrected so far, m.
    pub end: Vec<Pack4>,
    /// Velocities with the corrections so far, m/s: of particles with contacts.
    pub velocity: Vec<Pack4>,
    /// Velocities at the start of the substep, m/s.
    pub past_velocity: Vec<Pack4>,
    /// Changes of velocity by impacts, m/s.
    pub impact: Vec<Pack4>,
}

impl Points {
    /// Reads the positions of all particles at the start of the substep.
    pub fn read_starts(&mut self, particles: &Particles) {
        read(&particles.start, &mut self.start);
    }

    /// Reads the positions of all particles, corrected so far.
    pub fn read_ends(&mut self, particles: &Particles) {
        read(&particles.end, &mut self.end);
    }

    /// Reads the velocities of some particles.
    pub fn read_velocities(&mut self, particles: &Particles, some: &[u32]) {
        let Self { velocity, past_velocity, impact, end, .. } = self;
        let of = [&particles.velocity, &particles.past_velocity, &particles.impact];
        for (into, from) in [velocity, past_velocity, impact].into_iter().zip(of) {
            into.resize(end.len(), vector(Vec3::ZERO));
            some.iter().for_each(|&at| into[at as usize] = vector(from[at as usize]));
        }
    }

    /// Adds what some particles have been pushed since positions were read to their velocities, at some rate, 1/s.
    pub fn add_pushes(&mut self, particles: &Particles, some: &[u32], rate: f32) {
        for at in some.iter().map(|&at| at as usize) {
            let push = vector_of(&self.end[at]) - Vec3A::from(particles.end[at]);
            self.velocity[at] = vector((vector_of(&self.velocity[at]) + push * rate).into());
        }
    }

    /// Writes the positions of some particles, and marks those that have moved.
    pub fn write_positions(&self, particles: &mut Particles, some: &[u32]) {
        for at in some.iter().map(|&at| at as usize) {
            let end = Vec3::from(vector_of(&self.end[at]));
            particles.touched[at] |= end != particles.end[at];
            particles.end[at] = end;
        }
    }

    /// Writes velocities and impacts of some particles, and marks those whose velocities have changed.
    pub fn write_velocities(&self, particles: &mut Particles, some: &[u32]) {
        for at in some.iter().map(|&at| at as usize) {
            let [velocity, impact] =
                [&self.velocity, &self.impact].map(|of| Vec3::from(vector_of(&of[at])));
            particles.touched[at] |= velocity != particles.velocity[at];
            particles.velocity[at] = velocity;
            particles.impact[at] = impact;
        }
    }
}

/// Reads vectors.
fn read(from: &[Vec3], into: &mut Vec<Pack4>) {
    into.clear();
    into.extend(from.iter().map(|&of| vector(of)));
}

/// A vector, and zero.
#[inline]
pub(in crate::contact) fn vector(of: Vec3) -> Pack4 {
    Pack4::new([of.x, of.y, of.z, 0.0])
}

/// The vector without the fourth number.
#[inline]
pub(in crate::contact) fn vector_of(of: &Pack4) -> Vec3A {
    Vec3A::from_vec4(Vec4::from_array(of.vector()))
}

/// The vectors of four particles in each lane.
#[inline(always)]
pub(in crate::contact) fn gather<L: Lane>(
    token: L::Token,
    vectors: &[Pack4],
    particles: &[[u32; Pack8::WIDTH]; 4],
) -> [V3<L>; 4] {
    [
        V3::gather(token, vectors, &particles[0]),
        V3::gather(token, vectors, &particles[1]),
        V3::gather(token, vectors, &particles[2]),
        V3::gather(token, vectors, &particles[3]),
    ]
}
