//! Edges that pass through triangles at the start of a substep are moved such that the curve in which the cloth intersects
//! itself becomes shorter (Volino and Magnenat-Thalmann 2006, "Resolving surface collisions through intersection contour
//! minimization"), or, near a border of the cloth, such that the border returns.

use glam::Vec3;

use crate::contact::itself::crossing::{Crossing, crossing};
use crate::contact::itself::mesh::{ContactMesh, Edge};
use crate::contact::itself::pairs::EdgeTriangle;
use crate::contact::itself::particles::{Particles, inverse_mass};

/// Speed at which tangled features come apart, m/s. Smaller: cloth stays tangled for long. Larger: links beside tangled
/// features are stretched.
const SPEED: f32 = 0.5;

/// Least cosine between an edge and the normal of the triangle that it passes through, where the gradient is infinite.
const LEAST_COSINE: f32 = 0.1;

/// Features that pass through one another at the start of a substep.
#[derive(Clone, Debug, Default)]
pub(in crate::contact) struct Tangles {
    pairs: Vec<EdgeTriangle>,
    /// Whether each particle is of such a feature.
    of_particle: Vec<bool>,
}

impl Tangles {
    /// None of a cloth's particles.
    #[cfg(test)]
    pub fn of_none(particles: usize) -> Self {
        Self { pairs: Vec::new(), of_particle: vec![false; particles] }
    }

    /// Whether any of some particles is of a tangled feature.
    pub fn contain_any(&self, particles: &[u32]) -> bool {
        particles.iter().any(|&particle| self.of_particle[particle as usize])
    }

    /// Marks their particles, which are moved though they have no contacts.
    pub fn mark_near(&self, is_near: &mut [bool]) {
        for at in self.pairs.iter().flat_map(EdgeTriangle::particles) {
            is_near[at as usize] = true;
        }
    }

    pub fn is_any(&self) -> bool {
        !self.pairs.is_empty()
    }

    /// Forgets all, given the number of particles.
    pub fn clear(&mut self, particles: usize) {
        self.pairs.clear();
        self.of_particle.clear();
        self.of_particle.resize(particles, false);
    }

    /// Finds those among pairs that pass through each other, given the positions of all particles at the start of the substep, m.
    pub fn find(&mut self, pairs: &[EdgeTriangle], starts: &[Vec3]) {
        self.clear(starts.len());
        for pair in pairs {
            if crossing(pair, starts).is_some() {
                pair.particles().iter().for_each(|&at| self.of_particle[at as usize] = true);
                self.pairs.push(*pair);
            }
        }
    }

    /// Moves all in a substep of the length `step`, s.
    pub fn untangle(&self, mesh: &ContactMesh, particles: &mut Particles, step: f32) {
        for pair in &self.pairs {
            let Some(crossing) = crossing(pair, &particles.start) else { continue };
            let edge = &mesh.edges[pair.index as usize];
            if let Some(direction) = direction(edge, pair.triangle, &particles.start) {
                push(pair, &crossing, direction * (SPEED * step), particles);
            }
        }
    }
}

/// Unit direction in which an edge must move relative to the triangle that it passes through: near a border back to the
/// side of its inner end, else along the gradient G = Σ R − 2 (E·R)/(E·N) N of the curve's length, where E is the edge's
/// direction, N the triangle's normal, and R the direction of the curve, away from the edge, in each triangle beside the
/// edge. A straight curve from border to border has no gradient.
fn direction(edge: &Edge, triangle: [u32; 3], positions: &[Vec3]) -> Option<Vec3> {
    let at = |particle: u32| positions[particle as usize];
    let [p, q] = edge.ends.map(at);
    let [a, b, c] = triangle.map(at);
    let normal = (b - a).cross(c - a).try_normalize()?;
    if let Some(inner) = edge.inner_end {
        return Some(normal * normal.dot([p, q][inner] - a).signum());
    }
    let along = (q - p).try_normalize()?;
    let cosine = along.dot(normal);
    let cosine = cosine.signum() * cosine.abs().max(LEAST_COSINE);
    let of_wing = |wing: u32| {
        let inwards = at(wing) - p;
        let curve = along.cross(inwards).cross(normal).try_normalize()?;
        let across = inwards - along * inwards.dot(along);
        let curve = if curve.dot(across) < 0.0 { -curve } else { curve };
        Some(curve - normal * (2.0 * along.dot(curve) / cosine))
    };
    edge.wings.iter().flatten().filter_map(|&wing| of_wing(wing)).sum::<Vec3>().try_normalize()
}

/// Moves an edge relative to a triangle, m, by inverse masses.
fn push(pair: &EdgeTriangle, crossing: &Crossing, by: Vec3, particles: &mut Particles) {
    let [of_a, of_b, of_c] = crossing.coordinates;
    let factors = [1.0 - crossing.along, crossing.along, -of_a, -of_b, -of_c];
    let of_pair = pair.particles().map(|particle| particle as usize);
    let Some(inverse) = inverse_mass(particles, of_pair.into_iter().zip(factors)) else { return };
    for (&particle, factor) in of_pair.iter().zip(factors) {
        particles.end[particle] += by * (particles.inverse_mass[particle] * factor / inverse);
        particles.touched[particle] = true;
    }
}
