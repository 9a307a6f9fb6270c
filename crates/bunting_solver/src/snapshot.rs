//! The state of one cloth, apart from any batch.

use glam::Vec3;

use crate::fabric::Fabric;

/// Positions and velocities of a cloth's particles, in its frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ClothSnapshot {
    /// Positions in the cloth's frame, m.
    pub positions: Vec<Vec3>,
    /// Velocities relative to the world along the axes of the cloth's frame, m/s.
    pub velocities: Vec<Vec3>,
}

impl ClothSnapshot {
    /// The fabric as it was cut, at rest.
    #[must_use]
    pub fn at_rest(fabric: &Fabric) -> Self {
        Self {
            positions: fabric.rest_positions().to_vec(),
            velocities: vec![Vec3::ZERO; fabric.particle_count()],
        }
    }

    /// Whether every number is finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.positions.iter().chain(&self.velocities).all(|vector| vector.is_finite())
    }
}
