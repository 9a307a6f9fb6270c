//! The state of one cloth, apart from any batch.

use glam::Vec3;

use crate::fabric::Fabric;
use crate::step::bdf::Past;

/// Positions and velocities of a cloth's particles, in its frame.
///
/// One that was taken from a batch also holds what the integrator remembers, so that a cloth that is
/// moved to another batch goes on bit for bit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ClothSnapshot {
    /// Positions in the cloth's frame, m.
    pub positions: Vec<Vec3>,
    /// Velocities relative to the world along the axes of the cloth's frame, m/s.
    pub velocities: Vec<Vec3>,
    pub(crate) history: Option<History>,
}

/// What second order and stiff bending remember of earlier substeps.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct History {
    /// How long it is, and of which substeps.
    pub past: Past,
    /// Changes of position in the last substep and in the one before, m.
    pub displacements: [Vec<Vec3>; 2],
    /// Velocities one and two substeps earlier, m/s.
    pub older_velocities: [Vec<Vec3>; 2],
    /// What stretch does to each particle, m/s².
    pub memory: Vec<Vec3>,
    /// What part of what changes its velocity each particle follows; empty where all follow wholly.
    pub shares: Vec<f32>,
}

impl ClothSnapshot {
    /// A state without a past: the next substep is of first order.
    #[must_use]
    pub const fn new(positions: Vec<Vec3>, velocities: Vec<Vec3>) -> Self {
        Self { positions, velocities, history: None }
    }

    /// The fabric as it was cut, at rest.
    #[must_use]
    pub fn at_rest(fabric: &Fabric) -> Self {
        Self::new(fabric.rest_positions().to_vec(), vec![Vec3::ZERO; fabric.particle_count()])
    }

    /// Whether the fabric lies as it was cut, and does not move.
    #[must_use]
    pub fn is_at_rest(&self, fabric: &Fabric) -> bool {
        self.positions == fabric.rest_positions()
            && self.velocities.iter().all(|&velocity| velocity == Vec3::ZERO)
    }

    /// Positions and velocities of some of the particles, as of a coarser fabric that shares them.
    #[must_use]
    pub fn of(&self, particles: &[u32]) -> Self {
        let pick = |all: &[Vec3]| particles.iter().map(|&at| all[at as usize]).collect();
        Self::new(pick(&self.positions), pick(&self.velocities))
    }

    /// The same positions and velocities, without a past.
    #[must_use]
    pub fn forgetful(self) -> Self {
        Self { history: None, ..self }
    }

    /// Whether every number is finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.positions.iter().chain(&self.velocities).all(|vector| vector.is_finite())
    }
}
