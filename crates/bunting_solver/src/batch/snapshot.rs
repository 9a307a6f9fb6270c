//! The state of one cloth outside a batch.

use glam::Vec3;

use crate::fabric::Fabric;
use crate::step::bdf::IntegratorHistory;

/// Positions and velocities of a cloth's particles, in its frame.
///
/// A snapshot taken from a batch also holds the integrator's history, so that a cloth that moves to another
/// batch continues with the same bits.
///
/// ```
/// use bunting_solver::{ClothSnapshot, FabricBuilder, Grid};
/// use glam::Vec3;
///
/// let fabric = FabricBuilder::grid(Grid::new(5, 5, 1.0, 1.0)).build()?;
/// let mut thrown = ClothSnapshot::at_rest(&fabric);
/// (0..25).for_each(|particle| thrown.add_velocity(particle, 3.0 * Vec3::Z));
/// assert!(!thrown.is_at_rest(&fabric));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ClothSnapshot {
    /// Positions in the cloth's frame, m.
    #[cfg_attr(feature = "serde", serde(with = "crate::packed"))]
    pub positions: Vec<Vec3>,
    /// Velocities relative to the world along the axes of the cloth's frame, m/s.
    #[cfg_attr(feature = "serde", serde(with = "crate::packed"))]
    pub velocities: Vec<Vec3>,
    pub(crate) history: Option<SnapshotHistory>,
}

/// State of earlier substeps, for the integrator's second order.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct SnapshotHistory {
    pub integrator: IntegratorHistory,
    /// Changes of position in the last substep and in the one before, m.
    #[cfg_attr(feature = "serde", serde(with = "crate::packed::pair"))]
    pub displacements: [Vec<Vec3>; 2],
    /// Velocities one and two substeps earlier, m/s.
    #[cfg_attr(feature = "serde", serde(with = "crate::packed::pair"))]
    pub older_velocities: [Vec<Vec3>; 2],
    /// Under-relaxation factor of each particle; empty where all are 1.
    pub relaxation: Vec<f32>,
}

impl ClothSnapshot {
    /// A state without a history: the next substep is of first order.
    #[must_use]
    pub const fn new(positions: Vec<Vec3>, velocities: Vec<Vec3>) -> Self {
        Self { positions, velocities, history: None }
    }

    /// The fabric at its rest positions, without velocities.
    #[must_use]
    pub fn at_rest(fabric: &Fabric) -> Self {
        Self::new(fabric.rest_positions().to_vec(), vec![Vec3::ZERO; fabric.particle_count()])
    }

    /// Whether all particles are at the fabric's rest positions and do not move.
    #[must_use]
    pub fn is_at_rest(&self, fabric: &Fabric) -> bool {
        self.positions == fabric.rest_positions()
            && self.velocities.iter().all(|&velocity| velocity == Vec3::ZERO)
    }

    /// Positions and velocities of some of the particles, in the given order: the state of a coarser fabric
    /// with these particles.
    #[must_use]
    pub fn of(&self, particles: &[u32]) -> Self {
        let pick = |all: &[Vec3]| particles.iter().map(|&at| all[at as usize]).collect();
        Self::new(pick(&self.positions), pick(&self.velocities))
    }

    /// The state without the integrator's history.
    #[must_use]
    pub fn without_history(self) -> Self {
        Self { history: None, ..self }
    }

    /// Changes the velocity of a particle by an impulse, m/s, as if the particle had had the changed velocity in the
    /// substeps before, too: the integrator then extrapolates no change, and momentum changes by exactly this. Meant for
    /// particles that are not pinned.
    ///
    /// # Panics
    ///
    /// There is no such particle.
    pub fn add_velocity(&mut self, particle: usize, change: Vec3) {
        self.velocities[particle] += change;
        let Some(history) = &mut self.history else { return };
        let displacements = history.displacements.iter_mut();
        for (displacements, step) in displacements.zip(history.integrator.steps()) {
            displacements[particle] += change * step;
        }
        history.older_velocities.iter_mut().for_each(|velocities| velocities[particle] += change);
    }

    /// Multiplies all velocities, as if the cloth had had the changed ones in the substeps before, too.
    pub fn scale_velocities(&mut self, factor: f32) {
        let history = self.history.iter_mut();
        let of_history =
            history.flat_map(|it| it.displacements.iter_mut().chain(&mut it.older_velocities));
        for vectors in of_history.chain([&mut self.velocities]) {
            vectors.iter_mut().for_each(|vector| *vector *= factor);
        }
    }

    /// Whether every number is finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.positions.iter().chain(&self.velocities).all(|vector| vector.is_finite())
    }

    /// Whether the state is one of so many particles: every list has as many elements, those of the integrator's history
    /// included.
    #[must_use]
    pub fn is_of(&self, particles: usize) -> bool {
        self.history.as_ref().is_none_or(|history| history.is_of(particles))
            && [&self.positions, &self.velocities].iter().all(|list| list.len() == particles)
    }
}

impl SnapshotHistory {
    fn is_of(&self, particles: usize) -> bool {
        let lists = self.displacements.iter().chain(&self.older_velocities);
        let is_relaxed = !self.relaxation.is_empty();
        lists.into_iter().all(|list| list.len() == particles)
            && (!is_relaxed || self.relaxation.len() == particles)
    }
}
