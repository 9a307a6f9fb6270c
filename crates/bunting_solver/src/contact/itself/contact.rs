//! A contact of two features: C = n·Σ wᵢ xᵢ − d ≥ 0, with Coulomb friction.
//!
//! A contact has four particles with factors wᵢ: one and the negative barycentric coordinates of a particle over a
//! triangle, or those of the closest points of two edges. Normal and factors are kept as long as the particles have hardly
//! moved. A feature that has passed through another in the substep returns to the side on which it began.

use glam::Vec3;

use crate::constants::LEAST_LENGTH;
use crate::contact::itself::near::Kind;
use crate::contact::itself::particles::{Particles, inverse_mass, relative};

/// Part of a contact's distance by which its particles may move before its closest points are found again. Larger: normals
/// are those of features that have moved on. Smaller: costs more.
const FRESH: f32 = 0.1;

/// Part of their distance below which features are pressed together. Larger: layers at rest tremble. Smaller: they pass
/// through one another by under-relaxation.
const PRESSED: f32 = 0.5;

/// Depth that is left alone, m. Larger: layers at rest tremble. Smaller: rounding errors cost sweeps.
const LEAST_DEPTH: f32 = 1e-6;

/// Approach that is left alone, m/s. Larger: layers at rest tremble. Smaller: rounding errors cost sweeps.
const LEAST_APPROACH: f32 = 1e-4;

/// Two features that touch, or may touch in later sweeps.
#[derive(Clone, Copy, Debug)]
pub(in crate::contact) struct Contact {
    pub particles: [u32; 4],
    pub kind: Kind,
    /// Distance that the features keep, m.
    pub distance: f32,
    /// Coulomb friction coefficient.
    pub friction: f32,
    /// Sign of the height, or of the volume, at the start of the substep, if the features have passed through one
    /// another since; else zero.
    pub passed: f32,
    /// Unit normal and factors when the closest points were found last.
    pub normal: Vec3,
    pub factors: [f32; 4],
    /// Whether the features faced each other then.
    pub is_facing: bool,
    /// The [`travel`](Particles::travel) of the four particles, m, up to which normal and factors are kept.
    pub fresh: f32,
    /// Sum of the depths by which the features were moved apart, m.
    pub depth: f32,
    /// Sum of the approaches that were stopped, m/s.
    pub stopped: f32,
    /// What of this was an impact, m/s.
    pub impact: f32,
}

impl Contact {
    /// The particles of both features.
    pub fn particles(&self) -> impl Iterator<Item = usize> + use<> {
        self.particles.into_iter().map(|particle| particle as usize)
    }

    /// Whether the features are still much nearer than they must be.
    pub fn is_pressed(&self, particles: &Particles) -> bool {
        self.is_facing && self.gap(particles) < PRESSED * self.distance
    }

    /// Whether the features are as near as they may be, given what counts as such, m.
    pub fn is_touching(&self, particles: &Particles, within: f32) -> bool {
        self.is_facing && self.gap(particles) < self.distance + within
    }

    /// Distance of the features along the normal, m.
    fn gap(&self, particles: &Particles) -> f32 {
        relative(&particles.end, self.particles, self.factors).dot(self.normal)
    }

    /// Finds normal and factors anew.
    fn find(&mut self, particles: &Particles) {
        let at = self.particles.map(|particle| particles.end[particle as usize]);
        let near = self.kind.near(at, self.passed);
        self.is_facing = near.is_some();
        if let Some(near) = near {
            (self.normal, self.factors) = (near.normal, near.factors);
        }
    }

    /// Moves the features apart, given the travel of the four particles, m, up to which they stay farther apart than they
    /// must. Returns whether it did.
    pub fn project(&mut self, particles: &mut Particles, reach: &mut f32) -> bool {
        let travel: f32 = self.particles.iter().map(|&at| particles.travel[at as usize]).sum();
        if travel < *reach {
            return false;
        }
        if travel >= self.fresh {
            self.find(particles);
            self.fresh = travel + FRESH * self.distance;
        }
        if !self.is_facing {
            *reach = self.fresh;
            return false;
        }
        let gap = self.gap(particles);
        let depth = (self.distance - gap).max(-self.depth);
        if depth.abs() < LEAST_DEPTH {
            *reach = travel + (gap - self.distance).max(0.0);
            return false;
        }
        *reach = 0.0;
        let Some(inverse) = self.inverse_mass(particles) else { return false };
        let slide = relative(&particles.end, self.particles, self.factors)
            - relative(&particles.start, self.particles, self.factors);
        let slide = slide - self.normal * slide.dot(self.normal);
        let held = (self.friction * depth.max(0.0) / slide.length().max(LEAST_LENGTH)).min(1.0);
        let by = (self.normal * depth - slide * held) / inverse;
        for (&particle, factor) in self.particles.iter().zip(self.factors) {
            let particle = particle as usize;
            let factor = particles.inverse_mass[particle] * factor;
            let by = by * factor;
            particles.shift(particle, by);
            particles.touched[particle] |= factor != 0.0;
        }
        self.depth += depth;
        true
    }

    /// Stops the approach of the features, and slows their slide. What it gave before it takes back where other contacts
    /// have given too much: else features would leave each other in each substep, and layers at rest would tremble. Returns
    /// whether anything changed.
    pub fn stop(&mut self, particles: &mut Particles) -> bool {
        let velocity = relative(&particles.velocity, self.particles, self.factors);
        let approach = (-velocity.dot(self.normal)).max(-self.stopped);
        if approach.abs() < LEAST_APPROACH {
            return false;
        }
        let Some(inverse) = self.inverse_mass(particles) else { return false };
        let slide = velocity - self.normal * velocity.dot(self.normal);
        let most = self.friction * approach.max(0.0);
        let held = (most / slide.length().max(LEAST_LENGTH)).min(1.0);
        let change = (self.normal * approach - slide * held) / inverse;
        self.stopped += approach;
        // As far as the features approached each other at the start of the substep, this is an impact.
        let past = relative(&particles.past_velocity, self.particles, self.factors);
        let impact = (-past.dot(self.normal)).max(0.0).min(self.stopped);
        let part = (impact - self.impact) / approach;
        self.impact = impact;
        for (&particle, factor) in self.particles.iter().zip(self.factors) {
            let particle = particle as usize;
            let change = change * (particles.inverse_mass[particle] * factor);
            particles.velocity[particle] += change;
            particles.impact[particle] += change * part;
        }
        true
    }

    /// Inverse mass of the relative motion of the features, 1/m²; none if their points are almost pinned.
    fn inverse_mass(&self, particles: &Particles) -> Option<f32> {
        inverse_mass(particles, self.particles().zip(self.factors))
    }
}
