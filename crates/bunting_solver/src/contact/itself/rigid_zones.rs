//! Features that still pass through one another at the end of a substep return to where they began, moved by their mean
//! displacement (Provot 1997, "Collision and self-collision handling in cloth model dedicated to design garments").
//!
//! Particles of features that pass through one another are one zone. A zone that meets further features when it has
//! returned takes them in, until nothing passes through anything. Zones that have grown too often, or from which cloth is drawn out, are
//! given up: features then pass through one another in this substep, and come apart as tangles do.

use glam::Vec3;

use crate::contact::itself::crossing::crossing;
use crate::contact::itself::mesh::Edge;
use crate::contact::itself::pairs::EdgeTriangle;
use crate::contact::itself::particles::Particles;
use crate::contact::itself::untangle::Tangles;

/// Most times that zones grow. Fewer: features of large piles pass through one another. More: costs more in piles, and
/// zones as large as the cloth leave its pins behind.
const GROWTHS: usize = 24;

/// Greatest strain of edges beside zones. Smaller: large piles that hit something pass through one another. Larger: cloth that is drawn through
/// something narrow is held by its zones, and the more it is drawn out, the more of it passes through something.
const DRAWN_OUT: f32 = 2.0;

/// Zones of particles, as a forest: each particle has a parent in its zone, the root itself.
struct Zones(Vec<u32>);

impl Zones {
    fn root(&mut self, mut particle: u32) -> u32 {
        while self.0[particle as usize] != particle {
            let grandparent = self.0[self.0[particle as usize] as usize];
            self.0[particle as usize] = grandparent;
            particle = grandparent;
        }
        particle
    }

    /// Unites the zones of particles; returns whether they were several.
    fn unite(&mut self, mut particles: impl Iterator<Item = u32>) -> bool {
        let Some(first) = particles.next() else { return false };
        let mut were_several = false;
        for particle in particles {
            let [one, other] = [first, particle].map(|particle| self.root(particle));
            self.0[one.max(other) as usize] = one.min(other);
            were_several |= one != other;
        }
        were_several
    }
}

/// The zones of a cloth in a substep.
pub(in crate::contact) struct RigidZones {
    zones: Zones,
    /// Positions before any zone returned, m.
    corrected: Vec<Vec3>,
    /// Whether each particle has moved when zones were moved last; empty before.
    moved: Vec<bool>,
    growths: usize,
    are_given_up: bool,
}

impl RigidZones {
    /// No zones yet.
    pub fn new(particles: &Particles) -> Self {
        Self {
            zones: Zones((0..particles.start.len() as u32).collect()),
            corrected: particles.end.clone(),
            moved: Vec::new(),
            growths: 0,
            are_given_up: false,
        }
    }

    /// Returns zones to where they began, moved by their mean displacement, until no pair passes through one another.
    /// Returns whether any zone grew and none was given up. Tangled features are left alone.
    pub fn grow(
        &mut self,
        pairs: &[EdgeTriangle],
        tangles: &Tangles,
        particles: &mut Particles,
    ) -> bool {
        let before = self.growths;
        // The pairs may be others than those of the last call.
        self.moved.clear();
        while self.unite_crossing(pairs, tangles, &particles.end) {
            if self.growths == GROWTHS {
                self.give_up(particles);
                return false;
            }
            self.growths += 1;
            self.move_zones(particles);
        }
        self.growths > before
    }

    /// Whether zones had grown too often.
    pub fn are_given_up(&self) -> bool {
        self.are_given_up
    }

    /// Whether any edge between a zone and other cloth is drawn out too far.
    pub fn draw_out(&self, edges: &[Edge], particles: &Particles) -> bool {
        let Particles { end, touched, .. } = particles;
        edges.iter().any(|edge| {
            let [one, other] = edge.ends.map(|end| end as usize);
            let farthest = (1.0 + DRAWN_OUT) * edge.length;
            touched[one] != touched[other]
                && end[one].distance_squared(end[other]) > farthest * farthest
        })
    }

    /// Puts all particles where they were before any zone returned.
    pub fn give_up(&mut self, particles: &mut Particles) {
        particles.end.clone_from(&self.corrected);
        particles.touched.fill(false);
        self.are_given_up = true;
    }

    /// Unites the zones of features that pass through one another; returns whether there were any.
    fn unite_crossing(&mut self, pairs: &[EdgeTriangle], tangles: &Tangles, ends: &[Vec3]) -> bool {
        let mut grew = false;
        let moved = |particle: u32| self.moved.get(particle as usize) != Some(&false);
        for pair in pairs {
            if !pair.particles().into_iter().any(moved) {
                continue;
            }
            let is_tangled =
                || tangles.contain_any(&pair.edge) && tangles.contain_any(&pair.triangle);
            if crossing(pair, ends).is_some() && !is_tangled() {
                grew |= self.zones.unite(pair.particles().into_iter());
            }
        }
        grew
    }

    /// Moves the particles of each zone to their starts, moved by the mean of their displacements.
    fn move_zones(&mut self, particles: &mut Particles) {
        let displacement = |particle: usize| self.corrected[particle] - particles.start[particle];
        let sums = Sums::of(&mut self.zones, particles, displacement);
        self.moved.resize(self.corrected.len(), false);
        for particle in 0..self.corrected.len() {
            let root = self.zones.root(particle as u32) as usize;
            let before = particles.end[particle];
            if let Some(mean) = sums.mean(root)
                && particles.inverse_mass[particle] != 0.0
            {
                particles.end[particle] = particles.start[particle] + mean;
                particles.touched[particle] = true;
            }
            self.moved[particle] = particles.end[particle] != before;
        }
    }

    /// Gives the particles of each zone their mean velocity.
    pub fn stop(&mut self, particles: &mut Particles) {
        let sums = Sums::of(&mut self.zones, particles, |particle| particles.velocity[particle]);
        for particle in 0..particles.start.len() {
            let root = self.zones.root(particle as u32) as usize;
            if let Some(mean) = sums.mean(root)
                && particles.inverse_mass[particle] != 0.0
            {
                let change = mean - particles.velocity[particle];
                particles.velocity[particle] += change;
                particles.impact[particle] += change;
            }
        }
    }
}

/// Sums over the particles of each zone, by its root.
struct Sums {
    mass: Vec<f32>,
    vector: Vec<Vec3>,
    members: Vec<u32>,
    pins: Vec<u32>,
    /// Sum over the pins.
    of_pins: Vec<Vec3>,
}

impl Sums {
    /// Sums masses and, times them, the vectors of particles.
    fn of(zones: &mut Zones, particles: &Particles, vector: impl Fn(usize) -> Vec3) -> Self {
        let count = zones.0.len();
        let mut sums = Self {
            mass: vec![0.0; count],
            vector: vec![Vec3::ZERO; count],
            members: vec![0; count],
            pins: vec![0; count],
            of_pins: vec![Vec3::ZERO; count],
        };
        for particle in 0..count {
            let root = zones.root(particle as u32) as usize;
            let inverse_mass = particles.inverse_mass[particle];
            sums.members[root] += 1;
            if inverse_mass == 0.0 {
                sums.pins[root] += 1;
                sums.of_pins[root] += vector(particle);
            } else {
                sums.mass[root] += 1.0 / inverse_mass;
                sums.vector[root] += vector(particle) / inverse_mass;
            }
        }
        sums
    }

    /// The mean vector of a zone, or of its pins if it holds any; none of a single particle.
    fn mean(&self, root: usize) -> Option<Vec3> {
        if self.members[root] < 2 {
            return None;
        }
        Some(match self.pins[root] {
            0 => self.vector[root] / self.mass[root],
            pins => self.of_pins[root] / pins as f32,
        })
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::{Edge, GROWTHS, RigidZones};
    use crate::contact::itself::pairs::EdgeTriangle;
    use crate::contact::itself::particles::Particles;
    use crate::contact::itself::untangle::Tangles;

    /// An edge that has passed through a triangle below it.
    fn passed() -> (Vec<EdgeTriangle>, Particles) {
        let pair = EdgeTriangle { index: 0, edge: [0, 1], triangle: [2, 3, 4] };
        let pairs = vec![pair];
        let mut particles = Particles::default();
        particles.resize(5);
        particles.start =
            [[0.2, 1.0, 0.2], [0.3, 2.0, 0.3], [0.0; 3], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
                .map(Vec3::from)
                .to_vec();
        particles.end.clone_from(&particles.start);
        particles.end[0].y = -0.5;
        particles.inverse_mass.fill(1.0);
        (pairs, particles)
    }

    #[test]
    fn features_that_pass_return_with_their_mean_displacement() {
        let (pairs, mut particles) = passed();
        let mut zones = RigidZones::new(&particles);
        assert!(zones.grow(&pairs, &Tangles::of_none(5), &mut particles) && !zones.are_given_up());
        for (start, end) in particles.start.iter().zip(&particles.end) {
            assert!(end.distance(*start - 0.3 * Vec3::Y) < 1e-6, "{start} {end}");
        }
    }

    /// Edges above triangles, of which the first has passed through its triangle. Each further edge ends at a corner of the
    /// triangle before it, just above its own triangle: it passes as soon as the zone that holds this corner moves down.
    fn passes_in_turn(count: u32) -> (Vec<EdgeTriangle>, Particles) {
        /// Distance of an edge's end from the triangle below it, m: less than the zone of all particles moves.
        const ABOVE: f32 = 1e-3;
        let mut pairs = Vec::new();
        let mut at = vec![Vec3::ZERO];
        for index in 0..count {
            // The corner that the next edge hangs from is the last one.
            let end = at.len() as u32 - 1;
            let below = at[end as usize] - ABOVE * Vec3::Y;
            let around = [[-1.0, 0.0, -1.0], [-1.0, 0.0, 1.0], [2.0, 0.0, 0.0]].map(Vec3::from);
            at.push(at[end as usize] + Vec3::Y);
            at.extend(around.map(|corner| below + corner));
            pairs.push(EdgeTriangle {
                index,
                edge: [end, end + 1],
                triangle: [end + 2, end + 3, end + 4],
            });
        }
        let mut particles = Particles::default();
        particles.resize(at.len());
        particles.end.clone_from(&at);
        particles.start = at;
        particles.end[0].y = -1.0;
        particles.inverse_mass.fill(1.0);
        (pairs, particles)
    }

    #[test]
    fn zones_take_in_what_they_meet_until_they_have_grown_too_often() {
        let (pairs, mut particles) = passes_in_turn(GROWTHS as u32);
        let count = particles.start.len();
        let mut zones = RigidZones::new(&particles);
        assert!(zones.grow(&pairs, &Tangles::of_none(count), &mut particles));
        assert!(!zones.are_given_up());
        let moved = -1.0 / count as f32 * Vec3::Y;
        for (start, end) in particles.start.iter().zip(&particles.end) {
            assert!(end.distance(*start + moved) < 1e-6, "{start} {end}");
        }
        let (pairs, mut particles) = passes_in_turn(GROWTHS as u32 + 1);
        let before = particles.end.clone();
        let mut zones = RigidZones::new(&particles);
        assert!(!zones.grow(&pairs, &Tangles::of_none(before.len()), &mut particles));
        assert!(zones.are_given_up());
        assert_eq!(particles.end, before);
        assert!(!particles.touched.contains(&true));
    }

    #[test]
    fn cloth_is_drawn_out_where_an_edge_beside_a_zone_is_three_times_as_long_as_at_rest() {
        let mut particles = Particles::default();
        particles.resize(3);
        particles.touched[0] = true;
        let edge =
            |other| Edge { ends: [0, other], length: 0.1, wings: [None; 2], inner_end: None };
        particles.end[1] = Vec3::new(0.29, 0.0, 0.0);
        particles.end[2] = Vec3::new(0.0, 0.31, 0.0);
        let zones = RigidZones::new(&particles);
        assert!(!zones.draw_out(&[edge(1)], &particles));
        assert!(zones.draw_out(&[edge(1), edge(2)], &particles));
        particles.touched[2] = true;
        assert!(!zones.draw_out(&[edge(1), edge(2)], &particles));
    }
}
