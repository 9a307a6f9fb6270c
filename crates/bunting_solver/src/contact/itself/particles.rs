//! The particles of a cloth in a substep, gathered from the lanes.

use glam::Vec3;

/// Least inverse mass of the relative motion of features, as a part of that of their lightest particle. Smaller: where light particles are
/// far from where features touch that are pinned or press on colliders, they are moved far away. Larger: such features pass through one
/// another until they return.
pub(in crate::contact) const LEAST_SHARE: f32 = 0.1;

/// The particles of a cloth in a substep.
#[derive(Clone, Debug, Default)]
pub(crate) struct Particles {
    /// Positions at the start of the substep, m.
    pub start: Vec<Vec3>,
    /// Positions, corrected so far, m.
    pub end: Vec<Vec3>,
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

    /// Length of a particle's way in this substep and the one before, m.
    pub fn way(&self, particle: usize) -> f32 {
        self.start[particle].distance(self.end[particle]) + self.past_way[particle]
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

/// Inverse mass of the relative motion of features, 1/m², given the factors of their particles; none if all are pinned. Where it is less than
/// a part of that of the lightest particle, it is that part.
pub(in crate::contact) fn inverse_mass(
    particles: &Particles,
    factors: impl Iterator<Item = (usize, f32)>,
) -> Option<f32> {
    let (mut sum, mut greatest) = (0.0, 0.0_f32);
    for (particle, factor) in factors {
        let inverse_mass = particles.inverse_mass[particle];
        sum += inverse_mass * factor * factor;
        greatest = greatest.max(inverse_mass);
    }
    (greatest > 0.0).then_some(sum.max(LEAST_SHARE * greatest))
}
