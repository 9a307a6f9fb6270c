//! Edges that pass through triangles at the start of a substep are moved such that the curve in which the cloth intersects
//! itself becomes shorter (Volino and Magnenat-Thalmann 2006, "Resolving surface collisions through intersection contour
//! minimization"), or, near a border of the cloth, such that the border returns. Their motion relative to one another is stopped, since what
//! holds them together, as pins that cross for ever, answers to each of these moves.

use glam::Vec3;

use crate::contact::itself::crossing::{Crossing, crossing};
use crate::contact::itself::mesh::{ContactMesh, Edge};
use crate::contact::itself::pairs::EdgeTriangle;
use crate::contact::itself::particles::{Particles, inverse_mass};

/// Greatest speed at which particles of tangled features come apart, m/s. Smaller: cloth stays tangled for long. Larger: links beside tangled
/// features are stretched, and cloth whose pins cross shakes.
const SPEED: f32 = 0.25;

/// Least cosine between an edge and the normal of the triangle that it passes through, where the gradient is infinite.
const LEAST_COSINE: f32 = 0.1;

/// Features that pass through one another at the start of a substep.
#[derive(Clone, Debug, Default)]
pub(in crate::contact) struct Tangles {
    pairs: Vec<EdgeTriangle>,
    /// Whether each particle is of such a feature.
    of_particle: Vec<bool>,
    /// Scratch array: positions before particles were moved, m.
    before: Vec<Vec3>,
}

impl Tangles {
    /// None of a cloth's particles.
    #[cfg(test)]
    pub fn of_none(particles: usize) -> Self {
        Self { of_particle: vec![false; particles], ..Self::default() }
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
    pub fn untangle(&mut self, mesh: &ContactMesh, particles: &mut Particles, step: f32) {
        if self.pairs.is_empty() {
            return;
        }
        let farthest = SPEED * step;
        self.before.clone_from(&particles.end);
        for pair in &self.pairs {
            let edge = &mesh.edges[pair.index as usize];
            let direction = direction(edge, pair.triangle, &particles.start);
            if let Some((meeting, direction)) = Meeting::of(pair, particles).zip(direction) {
                let Particles { end, inverse_mass, touched, .. } = particles;
                meeting.push(direction * farthest, inverse_mass, end, touched);
            }
        }
        // An edge may pass through many triangles, each of which has pushed it.
        for (end, before) in particles.end.iter_mut().zip(&self.before) {
            *end = *before + (*end - before).clamp_length_max(farthest);
        }
    }

    /// Stops their motion relative to one another.
    pub fn stop(&self, particles: &mut Particles) {
        for pair in &self.pairs {
            let Some(meeting) = Meeting::of(pair, particles) else { continue };
            let Particles { velocity, inverse_mass, touched, .. } = particles;
            meeting.push(-meeting.relative(velocity), inverse_mass, velocity, touched);
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

/// The points of an edge and of a triangle that meet, as sums over the particles of both.
struct Meeting {
    particles: [usize; 5],
    /// Part of each particle in the point of the edge less that of the triangle.
    factors: [f32; 5],
    /// Inverse mass of the relative motion, 1/m².
    inverse_mass: f32,
}

impl Meeting {
    /// Where a pair meets at the start of the substep; none if it does not, or is held by pins.
    fn of(pair: &EdgeTriangle, particles: &Particles) -> Option<Self> {
        let Crossing { along, coordinates: [of_a, of_b, of_c] } = crossing(pair, &particles.start)?;
        let factors = [1.0 - along, along, -of_a, -of_b, -of_c];
        let of_pair = pair.particles().map(|particle| particle as usize);
        let inverse_mass = inverse_mass(particles, of_pair.into_iter().zip(factors))?;
        Some(Self { particles: of_pair, factors, inverse_mass })
    }

    /// The vector of the edge's point less that of the triangle's, given those of all particles.
    fn relative(&self, vectors: &[Vec3]) -> Vec3 {
        let terms = self.particles.iter().zip(self.factors);
        terms.map(|(&particle, factor)| vectors[particle] * factor).sum()
    }

    /// Changes this by inverse masses, and marks the particles.
    fn push(&self, by: Vec3, inverse_masses: &[f32], vectors: &mut [Vec3], touched: &mut [bool]) {
        for (&particle, factor) in self.particles.iter().zip(self.factors) {
            vectors[particle] += by * (inverse_masses[particle] * factor / self.inverse_mass);
            touched[particle] = true;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fabric::{FabricBuilder, Grid};

    const STEP: f32 = 1.0 / 120.0;

    /// Two squares that pass through each other, one of which moves.
    fn tangled() -> (ContactMesh, Particles, Tangles) {
        let fabric = FabricBuilder::grid(Grid::new(2, 2, 1.0, 1.0)).build().expect("a good grid");
        let mesh = ContactMesh::of(&fabric);
        let both = ContactMesh::joined([(&mesh, 4), (&mesh, 4)].into_iter());
        let mut particles = Particles::default();
        particles.resize(8);
        for (at, rest) in fabric.rest_positions().iter().enumerate() {
            particles.start[at] = *rest;
            particles.start[4 + at] = Vec3::new(0.45 + 0.1 * rest.y, rest.y + 0.3, rest.x - 0.4);
            particles.velocity[at] = Vec3::new(1.0, 2.0, 3.0);
        }
        particles.end.clone_from(&particles.start);
        particles.inverse_mass.fill(1.0);
        let edges = both.edges.iter().map(|edge| edge.ends).enumerate();
        let triangles = fabric.triangles().iter().flat_map(|it| [*it, it.map(|at| at + 4)]);
        let pairs: Vec<EdgeTriangle> = edges
            .flat_map(|(index, edge)| {
                let index = index as u32;
                triangles.clone().map(move |triangle| EdgeTriangle { index, edge, triangle })
            })
            .filter(|pair| pair.edge.iter().all(|end| !pair.triangle.contains(end)))
            .collect();
        let mut tangles = Tangles::default();
        tangles.find(&pairs, &particles.start);
        assert!(tangles.pairs.len() > 2, "{} pairs", tangles.pairs.len());
        (both, particles, tangles)
    }

    #[test]
    fn no_particle_comes_apart_faster_than_it_may() {
        let (mesh, mut particles, mut tangles) = tangled();
        tangles.untangle(&mesh, &mut particles, STEP);
        let ways = particles.end.iter().zip(&particles.start).map(|(end, at)| end.distance(*at));
        let farthest = ways.fold(0.0, f32::max);
        assert!(farthest > 0.0 && farthest < 1.001 * SPEED * STEP, "{farthest} m");
    }

    #[test]
    fn what_is_tangled_does_not_move_relative_to_one_another() {
        let (_, mut particles, tangles) = tangled();
        let fastest = |particles: &Particles| {
            let meetings = tangles.pairs.iter().filter_map(|pair| Meeting::of(pair, particles));
            let speeds = meetings.map(|it| it.relative(&particles.velocity).length());
            speeds.fold(0.0, f32::max)
        };
        assert!(fastest(&particles) > 3.0);
        (0..60).for_each(|_| tangles.stop(&mut particles));
        assert!(fastest(&particles) < 0.01, "{} m/s", fastest(&particles));
    }
}
