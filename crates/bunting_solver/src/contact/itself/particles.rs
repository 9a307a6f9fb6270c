//! The particles of a cloth in a substep, gathered from the lanes.

use glam::Vec3;

use crate::contact::itself::pairs::Pairs;

/// Least sum of the squared factors of particles that are not pinned. Smaller: contacts beside pins move particles far
/// away. Larger: layers beside pins pass through one another until they return.
const LEAST_FREE: f32 = 0.05;

/// The particles of a cloth in a substep.
#[derive(Clone, Debug, Default)]
pub(crate) struct Particles {
    /// Positions at the start of the substep, m.
    pub start: Vec<Vec3>,
    /// Positions, corrected so far, m.
    pub end: Vec<Vec3>,
    /// Length of the path along which contacts have moved each particle in the sweeps so far, m.
    pub travel: Vec<f32>,
    /// Longest of these paths, m.
    pub farthest: f32,
    /// Whether a contact may change the particle. Velocities are known of these alone.
    pub is_near: Vec<bool>,
    /// Inverse masses per unit area density, 1/m²; zero of pins.
    pub inverse_mass: Vec<f32>,
    /// Velocities at the end of the substep with the corrections so far, m/s.
    pub velocity: Vec<Vec3>,
    /// Velocities at the start of the substep, m/s.
    pub past_velocity: Vec<Vec3>,
    /// Lengths of the ways in the last substep, m.
    pub past_way: Vec<f32>,
    /// Changes of velocity by impacts, which stop an approach of the particles at the start of the substep, m/s.
    pub impact: Vec<Vec3>,
    /// Scratch array of positions of a cloth, m.
    pub after: Vec<Vec3>,
    /// Whether a contact has changed the particle.
    pub touched: Vec<bool>,
}

impl Particles {
    pub fn resize(&mut self, count: usize) {
        for vectors in [
            &mut self.start,
            &mut self.end,
            &mut self.velocity,
            &mut self.past_velocity,
            &mut self.impact,
        ] {
            vectors.resize(count, Vec3::ZERO);
        }
        self.inverse_mass.resize(count, 0.0);
        self.past_way.resize(count, 0.0);
        self.touched.resize(count, false);
        self.is_near.resize(count, false);
    }

    /// Counts the paths along which contacts move particles from here on.
    pub fn forget_travel(&mut self) {
        self.travel.clear();
        self.travel.resize(self.end.len(), 0.0);
        self.farthest = 0.0;
    }

    /// Moves a particle.
    #[inline]
    pub fn shift(&mut self, particle: usize, by: Vec3) {
        self.end[particle] += by;
        self.travel[particle] += by.length();
        self.farthest = self.farthest.max(self.travel[particle]);
    }

    /// Length of a particle's way in this substep and the one before, m.
    pub fn way(&self, particle: usize) -> f32 {
        self.start[particle].distance(self.end[particle]) + self.past_way[particle]
    }

    /// Marks the particles of pairs as near others.
    pub(in crate::contact) fn mark_near(&mut self, pairs: &Pairs) {
        self.is_near.fill(false);
        pairs.particles().for_each(|particle| self.is_near[particle] = true);
    }
}

/// Sum of four particles' vectors with the factors of a contact: those of one side are positive and sum up to one, those
/// of the other side are negative and sum up to minus one.
pub(in crate::contact) fn relative(
    vectors: &[Vec3],
    particles: [u32; 4],
    factors: [f32; 4],
) -> Vec3 {
    let terms = particles.iter().zip(factors);
    terms.fold(Vec3::ZERO, |sum, (&particle, factor)| sum + vectors[particle as usize] * factor)
}

/// Inverse mass of the relative motion of features, 1/m², given the factors of their particles; none if the points that
/// touch are almost pinned.
pub(in crate::contact) fn inverse_mass(
    particles: &Particles,
    factors: impl Iterator<Item = (usize, f32)>,
) -> Option<f32> {
    let (mut sum, mut free) = (0.0, 0.0);
    for (particle, factor) in factors {
        let inverse_mass = particles.inverse_mass[particle];
        sum += inverse_mass * factor * factor;
        free += if inverse_mass > 0.0 { factor * factor } else { 0.0 };
    }
    (free > LEAST_FREE).then_some(sum)
}
