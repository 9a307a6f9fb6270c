//! The particles of a cloth in a substep, gathered from the lanes.

use glam::Vec3;

/// The particles of a cloth in a substep.
#[derive(Clone, Debug, Default)]
pub(super) struct Particles {
    /// Positions at the start of the substep, m.
    pub start: Vec<Vec3>,
    /// Positions, corrected so far, m.
    pub end: Vec<Vec3>,
    /// Inverse masses per unit area density, 1/m²; zero of pins.
    pub inverse_mass: Vec<f32>,
    /// Velocities at the end of the substep with the corrections so far, m/s.
    pub velocity: Vec<Vec3>,
    /// Velocities at the start of the substep, m/s.
    pub past_velocity: Vec<Vec3>,
    /// Changes of velocity by impacts, which stop an approach of the particles at the start of the substep, m/s.
    pub impact: Vec<Vec3>,
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
        self.touched.resize(count, false);
    }
}

/// Sum of four particles' vectors with the factors of a contact: those of one side are positive and sum up to one, those
/// of the other side are negative and sum up to minus one.
pub(super) fn relative(vectors: &[Vec3], particles: [u32; 4], factors: [f32; 4]) -> Vec3 {
    let terms = particles.iter().zip(factors);
    terms.fold(Vec3::ZERO, |sum, (&particle, factor)| sum + vectors[particle as usize] * factor)
}
