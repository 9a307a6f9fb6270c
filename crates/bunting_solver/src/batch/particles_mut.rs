//! A view of one cloth's particles within a substep, for forces and constraints from outside the solver.

use glam::Vec3;

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Positions};
use crate::simd::lane::Pack;
use crate::simd::vec3::{Pack3, lane3, set_lane3};

/// The particles of one cloth between [`integrate`](crate::ClothBatch::integrate) and
/// [`update_velocities`](crate::ClothBatch::update_velocities). Positions are predictions, which constraints
/// correct; `update_velocities` turns corrections into velocity.
///
/// - A **constraint** moves predicted positions by [`set_position`](Self::set_position), before or after
///   `solve_constraints`; after it, nothing but the constraint itself decides where the particle ends.
/// - A **force** is given right after `integrate`, in every substep that it acts in, by
///   [`add_acceleration`](Self::add_acceleration).
/// - An **impulse** is given once, by [`add_velocity`](Self::add_velocity).
///
/// Vectors are along the axes of the cloth's frame in this substep. Particles are numbered as in the
/// [`Fabric`](crate::Fabric); methods panic if there is no particle with the given number. Pinned particles
/// cannot be moved: values written to them are ignored.
pub struct ParticlesMut<'a> {
    batch: &'a mut dyn ParticleAccess,
    lane: usize,
}

impl<'a> ParticlesMut<'a> {
    /// The cloth of a lane; none if the lane is empty, or outside a substep.
    pub(crate) fn new<P: Pack, Y: Layout<P>>(
        batch: &'a mut LaneBatch<P, Y>,
        lane: usize,
    ) -> Option<Self> {
        let exists = batch.clock.predicted && batch.lanes.get(lane)?.is_some();
        if !exists {
            return None;
        }
        batch.disturb(lane);
        Some(Self { batch, lane })
    }

    /// Number of particles.
    #[must_use]
    pub fn count(&self) -> usize {
        self.batch.count()
    }

    /// Effective length of the substep, s: a correction of a position by Δx changes the velocity by Δx over
    /// this length. With formulas of second order it is shorter than the substep.
    #[must_use]
    pub fn effective_step(&self) -> f32 {
        self.batch.effective_step(self.lane)
    }

    /// Inverse mass of a particle, 1/kg; zero if it is pinned. It includes the mass that the solver adds
    /// where few particles carry a large load.
    #[must_use]
    pub fn inverse_mass(&self, particle: usize) -> f32 {
        self.batch.inverse_mass(particle, self.lane)
    }

    /// Predicted position of a particle, with the corrections so far, m.
    #[must_use]
    pub fn position(&self, particle: usize) -> Vec3 {
        self.batch.position(particle, self.lane)
    }

    /// Predicted velocity of a particle relative to the world, m/s. It does not contain corrections of the
    /// position yet.
    #[must_use]
    pub fn velocity(&self, particle: usize) -> Vec3 {
        self.batch.velocity(particle, self.lane)
    }

    /// Corrects the predicted position of a particle, m. The correction becomes velocity at the end of the
    /// substep.
    pub fn set_position(&mut self, particle: usize, position: Vec3) {
        self.batch.set_position(particle, self.lane, position);
    }

    /// Accelerates a particle over this substep, m/s², as gravity does: velocity and predicted position
    /// change as if the acceleration had been part of the prediction. Call it right after `integrate`.
    ///
    /// Contacts, tethers and the number of substeps take gravity and wind into account, but not this
    /// acceleration.
    pub fn add_acceleration(&mut self, particle: usize, acceleration: Vec3) {
        self.batch.add_acceleration(particle, self.lane, acceleration);
    }

    /// Changes the velocity of a particle by an impulse, m/s: velocity and predicted position change as if
    /// the particle had had the changed velocity in this substep and in those before, so that the change is
    /// not extrapolated. Call it right after `integrate`.
    pub fn add_velocity(&mut self, particle: usize, change: Vec3) {
        self.batch.add_velocity(particle, self.lane, change);
    }

    /// Sets the velocity of a particle relative to the world, m/s, by an impulse: see
    /// [`add_velocity`](Self::add_velocity).
    pub fn set_velocity(&mut self, particle: usize, velocity: Vec3) {
        self.add_velocity(particle, velocity - self.velocity(particle));
    }
}

impl core::fmt::Debug for ParticlesMut<'_> {
    fn fmt(&self, formatter: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let Self { lane, .. } = self;
        formatter.debug_struct("ParticlesMut").field("lane", lane).finish_non_exhaustive()
    }
}

/// Access to a cloth's particles, at any width and in any layout.
trait ParticleAccess {
    fn count(&self) -> usize;
    fn effective_step(&self, cloth: usize) -> f32;
    fn inverse_mass(&self, particle: usize, cloth: usize) -> f32;
    fn position(&self, particle: usize, cloth: usize) -> Vec3;
    fn velocity(&self, particle: usize, cloth: usize) -> Vec3;
    fn set_position(&mut self, particle: usize, cloth: usize, position: Vec3);
    fn add_acceleration(&mut self, particle: usize, cloth: usize, acceleration: Vec3);
    fn add_velocity(&mut self, particle: usize, cloth: usize, change: Vec3);
}

impl<P: Pack, Y: Layout<P>> ParticleAccess for LaneBatch<P, Y> {
    fn count(&self) -> usize {
        self.fabric.particle_count()
    }

    fn effective_step(&self, cloth: usize) -> f32 {
        self.parameters.step.lanes()[Y::lanes(cloth).start]
    }

    fn inverse_mass(&self, particle: usize, cloth: usize) -> f32 {
        let (pack, lane) = self.layout.locate(particle, cloth);
        let density = self.lanes[cloth].as_ref().map_or(1.0, |state| state.material.area_density);
        self.masses.inverse[pack].lanes()[lane] / density
    }

    fn position(&self, particle: usize, cloth: usize) -> Vec3 {
        self.vector(self.positions.packs(), particle, cloth)
    }

    fn velocity(&self, particle: usize, cloth: usize) -> Vec3 {
        self.vector(&self.velocity, particle, cloth)
    }

    fn set_position(&mut self, particle: usize, cloth: usize, position: Vec3) {
        if self.fabric.is_pinned(particle) {
            return;
        }
        let (pack, lane) = self.layout.locate(particle, cloth);
        let stored = &mut self.positions.packs_mut()[pack];
        let before = lane3(stored, lane);
        set_lane3(stored, lane, position);
        // A correction from outside may turn the cloth about its pole.
        if let (Some(pole), Some(state)) = (self.pole_of(cloth), &mut self.lanes[cloth]) {
            let predicted =
                lane3(&self.scratch[pack], lane) + lane3(&self.displacement[pack], lane);
            let inertia = self.masses.inertia[pack].lanes()[lane];
            state.external_moment += pole.gained(inertia, predicted, [before, position]);
        }
    }

    fn add_acceleration(&mut self, particle: usize, cloth: usize, acceleration: Vec3) {
        let (pack, lane) = self.layout.locate(particle, cloth);
        let step = self.effective_step(cloth);
        // As gravity, on the true mass, whatever inertia is added to it; zero for pins.
        let area = self.fabric_of(cloth).fabric.particle_areas()[particle];
        let true_part = self.masses.inverse[pack].lanes()[lane] * area;
        let change = acceleration * (true_part * step);
        add(&mut self.velocity[pack], lane, change);
        self.shift_prediction(pack, lane, change * step);
    }

    fn add_velocity(&mut self, particle: usize, cloth: usize, change: Vec3) {
        if self.fabric.is_pinned(particle) {
            return;
        }
        let (pack, lane) = self.layout.locate(particle, cloth);
        for velocity in [&mut self.velocity, &mut self.older_velocity, &mut self.oldest_velocity] {
            add(&mut velocity[pack], lane, change);
        }
        // The position moves by β h Δv through the new velocity, and by (γ₁ + γ₂) h Δv through the
        // extrapolated displacements.
        let moved = change * self.clock.step;
        self.shift_prediction(pack, lane, moved);
        add(&mut self.older_displacement[pack], lane, moved);
    }
}

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Shifts the predicted position of a particle, m, without a correction. The position is computed as
    /// `update_velocities` does, as start plus displacement: a rounding error between the two would count as
    /// a correction and become a velocity.
    pub(crate) fn shift_prediction(&mut self, pack: usize, lane: usize, change: Vec3) {
        let start = lane3(&self.scratch[pack], lane);
        let before = lane3(&self.displacement[pack], lane);
        let position = &mut self.positions.packs_mut()[pack];
        let correction = lane3(position, lane) - (start + before);
        set_lane3(&mut self.displacement[pack], lane, before + change);
        set_lane3(position, lane, start + (before + change) + correction);
    }
}

/// Adds a vector to one lane.
fn add<P: Pack>(pack: &mut Pack3<P>, lane: usize, change: Vec3) {
    set_lane3(pack, lane, lane3(pack, lane) + change);
}

#[cfg(test)]
mod tests;
