//! The particles of a lone mesh as vectors, of which eight are gathered at once.

use fearless_simd::{Simd, f32x4, f32x8};

use crate::simd::lane::{Lane, Pack};
use crate::simd::registers::{Pack4, Pack8};
use crate::simd::transpose::{joined, split};
use crate::simd::vec3::V3;

/// A particle while corrections are summed: vectors of x, y, z and a fourth number.
#[derive(Clone, Debug)]
#[repr(C, align(32))]
pub(super) struct VectorParticle {
    /// Position before the corrections, m, and the inverse mass, 1/m².
    pub predicted: Pack4,
    /// Sum of the corrections, m, and zero.
    pub correction: Pack4,
}

impl VectorParticle {
    /// A particle at the origin.
    pub fn new() -> Self {
        let zero = Pack4::splat(0.0);
        Self { predicted: zero, correction: zero }
    }
}

/// The particles of a mesh.
pub(super) struct VectorParticles<'a>(pub &'a mut [VectorParticle]);

impl VectorParticles<'_> {
    /// The corrected position of a particle, m.
    #[inline(always)]
    pub fn position<S: Simd>(&self, token: S, particle: u32) -> f32x4<S> {
        let VectorParticle { predicted, correction } = &self.0[particle as usize];
        let predicted = <f32x4<S> as Lane>::load(token, predicted);
        predicted + <f32x4<S> as Lane>::load(token, correction)
    }

    /// The inverse mass of a particle, 1/m².
    #[inline(always)]
    pub fn inverse_mass(&self, particle: u32) -> f32 {
        self.0[particle as usize].predicted.vector()[3]
    }

    /// The inverse masses of eight particles, 1/m².
    #[inline(always)]
    pub fn inverse_masses<S: Simd>(&self, token: S, particles: &[u32; Pack8::WIDTH]) -> f32x8<S> {
        let mut masses = Pack8::splat(0.0);
        for (mass, &particle) in masses.lanes_mut().iter_mut().zip(particles) {
            *mass = self.inverse_mass(particle);
        }
        Lane::load(token, &masses)
    }

    /// Adds a vector times a factor to the correction of a particle, m.
    #[inline(always)]
    pub fn correct<S: Simd>(&mut self, token: S, particle: u32, by: f32x4<S>, factor: f32) {
        let correction = &mut self.0[particle as usize].correction;
        let sum = <f32x4<S> as Lane>::load(token, correction);
        sum.plus_product(by, Lane::splat(token, factor)).store(correction);
    }

    /// The corrected positions of eight particles, m.
    #[inline(always)]
    pub fn gather<S: Simd>(&self, token: S, particles: &[u32; Pack8::WIDTH]) -> V3<f32x8<S>> {
        let mut at = [<f32x4<S> as Lane>::splat(token, 0.0); Pack8::WIDTH];
        for (at, &particle) in at.iter_mut().zip(particles) {
            *at = self.position(token, particle);
        }
        joined(at)
    }

    /// Adds vectors times factors to the corrections of as many particles as are given, m.
    #[inline(always)]
    pub fn scatter<S: Simd>(
        &mut self,
        token: S,
        particles: &[u32],
        by: V3<f32x8<S>>,
        factors: f32x8<S>,
    ) {
        let mut stored = Pack8::splat(0.0);
        factors.store(&mut stored);
        for ((&particle, by), &factor) in particles.iter().zip(split(token, by)).zip(stored.lanes())
        {
            self.correct(token, particle, by, factor);
        }
    }
}
