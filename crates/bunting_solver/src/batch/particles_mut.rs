//! A view of one cloth's particles within a substep, for forces and constraints from outside the solver.

use glam::Vec3;

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Positions};
use crate::simd::lane::Pack;
use crate::simd::vec3::{Pack3, lane3, set_lane3};

/// The particles of one cloth between [`integrate`](crate::ClothBatch::integrate) and
/// [`update_velocities`](crate::ClothBatch::update_velocities): positions are predictions, which constraints
/// correct, and `update_velocities` turns corrections into velocity.
///
/// - A **constraint** moves predicted positions by [`set_position`](Self::set_position), before or after
///   `solve_constraints`; after it, nothing but the constraint itself decides where the particle ends.
/// - A **force** is given right after `integrate`, in every substep that it acts in, by
///   [`add_acceleration`](Self::add_acceleration).
/// - An **impulse** is given once, by [`add_velocity`](Self::add_velocity).
///
/// Vectors are along the axes of the cloth's frame as it is in this substep. Particles are numbered as in the
/// [`Fabric`](crate::Fabric); methods panic where there is no particle of that number. Pinned particles cannot be
/// moved: what is written to them is ignored.
pub struct ParticlesMut<'a> {
    batch: &'a mut dyn ParticleAccess,
    lane: usize,
}

impl<'a> ParticlesMut<'a> {
    /// The cloth of a lane; none if it is empty, or if no substep is under way.
    pub(crate) fn new<P: Pack, Y: Layout<P>>(
        batch: &'a mut LaneBatch<P, Y>,
        lane: usize,
    ) -> Option<Self> {
        let exists = batch.clock.predicted && batch.lanes.get(lane)?.is_some();
        exists.then_some(Self { batch, lane })
    }

    /// Number of particles.
    #[must_use]
    pub fn count(&self) -> usize {
        self.batch.count()
    }

    /// Effective length of the substep, s: a correction of a position by Δx changes the velocity by Δx over this.
    /// With formulas of second order it is shorter than the substep.
    #[must_use]
    pub fn effective_step(&self) -> f32 {
        self.batch.effective_step(self.lane)
    }

    /// Inverse mass of a particle, 1/kg; zero where it is pinned. It includes the mass that the solver adds where
    /// few particles carry a large load.
    #[must_use]
    pub fn inverse_mass(&self, particle: usize) -> f32 {
        self.batch.inverse_mass(particle, self.lane)
    }

    /// Predicted position of a particle, with the corrections so far, m.
    #[must_use]
    pub fn position(&self, particle: usize) -> Vec3 {
        self.batch.position(particle, self.lane)
    }

    /// Velocity of a particle relative to the world, as predicted, m/s. Corrections of the position are not in
    /// it yet.
    #[must_use]
    pub fn velocity(&self, particle: usize) -> Vec3 {
        self.batch.velocity(particle, self.lane)
    }

    /// Corrects the predicted position of a particle, m. The correction becomes velocity at the end of the
    /// substep.
    pub fn set_position(&mut self, particle: usize, position: Vec3) {
        self.batch.set_position(particle, self.lane, position);
    }

    /// Accelerates a particle over this substep, m/s², as gravity does: velocity and predicted position change
    /// as if the acceleration had been part of the prediction. To be called right after `integrate`.
    ///
    /// Contacts, tethers and the number of substeps are prepared for gravity and wind, and not for this
    /// acceleration.
    pub fn add_acceleration(&mut self, particle: usize, acceleration: Vec3) {
        self.batch.add_acceleration(particle, self.lane, acceleration);
    }

    /// Changes the velocity of a particle by an impulse, m/s: velocity and predicted position change as if the
    /// particle had entered this substep, and those before, with the changed velocity, so that the change is
    /// not extrapolated. To be called right after `integrate`.
    pub fn add_velocity(&mut self, particle: usize, change: Vec3) {
        self.batch.add_velocity(particle, self.lane, change);
    }

    /// Gives a particle this velocity relative to the world, m/s, by an impulse: see
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

/// Access to a particle of a cloth, at any width and in any layout.
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
        let (pack, lane) = self.layout.locate(particle, cloth);
        lane3(&self.positions.packs()[pack], lane)
    }

    fn velocity(&self, particle: usize, cloth: usize) -> Vec3 {
        let (pack, lane) = self.layout.locate(particle, cloth);
        lane3(&self.velocity[pack], lane)
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
        if let (Some(pole), Some(state)) = (self.pole, &mut self.lanes[cloth]) {
            let predicted =
                lane3(&self.scratch[pack], lane) + lane3(&self.displacement[pack], lane);
            let inertia = self.masses.inertia[pack].lanes()[lane];
            let moment = |at: Vec3| pole.moment(inertia, at, at - predicted);
            state.external_moment += moment(position) - moment(before);
        }
    }

    fn add_acceleration(&mut self, particle: usize, cloth: usize, acceleration: Vec3) {
        let (pack, lane) = self.layout.locate(particle, cloth);
        let step = self.effective_step(cloth);
        // As gravity, on the true mass, whatever inertia is added to it; zero for pins.
        let true_part =
            self.masses.inverse[pack].lanes()[lane] * self.fabric.particle_areas()[particle];
        let change = acceleration * (true_part * step);
        add(&mut self.velocity[pack], lane, change);
        add(&mut self.displacement[pack], lane, change * step);
        add(&mut self.positions.packs_mut()[pack], lane, change * step);
    }

    fn add_velocity(&mut self, particle: usize, cloth: usize, change: Vec3) {
        if self.fabric.is_pinned(particle) {
            return;
        }
        let (pack, lane) = self.layout.locate(particle, cloth);
        for velocity in [&mut self.velocity, &mut self.older_velocity, &mut self.oldest_velocity] {
            add(&mut velocity[pack], lane, change);
        }
        // β h Δv by the new velocity and (γ₁ + γ₂) h Δv by the extrapolated displacements.
        let moved = change * self.clock.step;
        add(&mut self.displacement[pack], lane, moved);
        add(&mut self.older_displacement[pack], lane, moved);
        add(&mut self.positions.packs_mut()[pack], lane, moved);
    }
}

/// Adds to the vector of one lane.
fn add<P: Pack>(pack: &mut Pack3<P>, lane: usize, change: Vec3) {
    set_lane3(pack, lane, lane3(pack, lane) + change);
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::Vec3;

    use crate::batch::lane_count::LaneCount;
    use crate::batch::snapshot::ClothSnapshot;
    use crate::batch::{ClothBatch, ParticlesMut};
    use crate::fabric::{Fabric, FabricBuilder, FabricMaterial, Grid};
    use crate::step::{Drive, StepSettings};

    const TICK: f32 = 1.0 / 60.0;
    const SETTINGS: [StepSettings; 2] = [StepSettings::yarns(3), StepSettings::gauss_seidel(4)];
    /// A single cloth across the lanes, cloths side by side, and scalar code with a scheme without chains.
    const LAYOUTS: [LaneCount; 2] = [LaneCount::One, LaneCount::Eight];

    fn sheet(pins: impl IntoIterator<Item = u32>) -> Arc<Fabric> {
        let builder = FabricBuilder::grid(Grid::new(9, 7, 1.0, 0.8)).pin(pins);
        Arc::new(builder.build().expect("a good fabric"))
    }

    /// A batch with a cloth in its last lane.
    fn batch_of(fabric: &Arc<Fabric>, lanes: LaneCount, drive: Drive) -> (ClothBatch, usize) {
        let mut batch = ClothBatch::new(Arc::clone(fabric), lanes);
        let lane = batch.lane_count() - 1;
        let rest = ClothSnapshot::at_rest(fabric);
        batch.replace(lane, &rest, FabricMaterial::COTTON).expect("a good cloth");
        batch.drive(lane, drive);
        (batch, lane)
    }

    /// Runs ticks with a force after the prediction and a constraint after the solver's own.
    fn run(
        (batch, lane): (&mut ClothBatch, usize),
        settings: StepSettings,
        ticks: usize,
        mut force: impl FnMut(&mut ParticlesMut),
        mut constraint: impl FnMut(&mut ParticlesMut),
    ) -> ClothSnapshot {
        for _ in 0..ticks {
            batch.begin_tick(TICK, settings);
            for _ in 0..settings.substeps {
                batch.integrate();
                force(&mut batch.particles_mut(lane).expect("a cloth"));
                batch.solve_constraints();
                constraint(&mut batch.particles_mut(lane).expect("a cloth"));
                batch.update_velocities();
            }
        }
        batch.snapshot_without_history(lane)
    }

    fn everywhere() -> impl Iterator<Item = (LaneCount, StepSettings)> {
        LAYOUTS.into_iter().flat_map(|lanes| SETTINGS.map(|settings| (lanes, settings)))
    }

    fn farthest(one: &[Vec3], other: &[Vec3]) -> f32 {
        one.iter().zip(other).map(|(one, other)| one.distance(*other)).fold(0.0, f32::max)
    }

    #[test]
    fn an_acceleration_equals_gravity() {
        let acceleration = Vec3::new(1.0, -3.0, 0.5);
        for pins in [vec![], vec![0, 8]] {
            let fabric = sheet(pins);
            for (lanes, settings) in everywhere() {
                let gravity = Drive { gravity: acceleration, ..Drive::NONE };
                let (mut batch, lane) = batch_of(&fabric, lanes, gravity);
                let expected = run((&mut batch, lane), settings, 20, |_| {}, |_| {});
                // The pole's direction and the bounds on stretch depend on gravity; here they do not matter.
                let (mut batch, lane) = batch_of(&fabric, lanes, Drive::NONE);
                let accelerate = |particles: &mut ParticlesMut| {
                    (0..particles.count())
                        .for_each(|at| particles.add_acceleration(at, acceleration));
                };
                let found = run((&mut batch, lane), settings, 20, accelerate, |_| {});
                let off = farthest(&expected.positions, &found.positions);
                assert!(off < 1e-5, "{lanes:?} {settings:?}: {off} m");
                let off = farthest(&expected.velocities, &found.velocities);
                assert!(off < 1e-4, "{lanes:?} {settings:?}: {off} m/s");
            }
        }
    }

    #[test]
    fn an_impulse_moves_a_free_cloth_steadily() {
        let change = Vec3::new(0.5, 1.0, -2.0);
        let fabric = sheet([]);
        for (lanes, settings) in everywhere() {
            let (mut batch, lane) = batch_of(&fabric, lanes, Drive::NONE);
            run((&mut batch, lane), settings, 2, |_| {}, |_| {});
            let mut given = false;
            let push = |particles: &mut ParticlesMut| {
                if !core::mem::replace(&mut given, true) {
                    (0..particles.count()).for_each(|at| particles.set_velocity(at, change));
                }
            };
            let found = run((&mut batch, lane), settings, 10, push, |_| {});
            let moved = change * (10.0 * TICK);
            let expected: Vec<Vec3> =
                fabric.rest_positions().iter().map(|at| *at + moved).collect();
            let damped = FabricMaterial::COTTON.damping * 10.0 * TICK;
            let off = farthest(&expected, &found.positions);
            assert!(off < 1e-5 + damped * moved.length(), "{lanes:?} {settings:?}: {off} m");
        }
    }

    #[test]
    fn a_position_constraint_holds() {
        let fabric = sheet([]);
        let held = [0, 8];
        for (lanes, settings) in everywhere() {
            let (mut batch, lane) = batch_of(&fabric, lanes, Drive::default());
            let hold = |particles: &mut ParticlesMut| {
                held.map(|at| particles.set_position(at, fabric.rest_positions()[at]));
            };
            let found = run((&mut batch, lane), settings, 60, |_| {}, hold);
            for at in held {
                assert_eq!(found.positions[at], fabric.rest_positions()[at], "{lanes:?}");
                assert!(found.velocities[at].length() < 1e-4, "{lanes:?} {settings:?}");
            }
            // Without the constraint the cloth would have fallen by 4.9 m.
            let mean: Vec3 = found.positions.iter().sum::<Vec3>() / found.positions.len() as f32;
            assert!(mean.y > -1.0, "{lanes:?} {settings:?}: {mean}");
        }
    }

    #[test]
    fn masses_are_those_of_the_cloth_and_pins_stay() {
        let fabric = sheet([0, 1, 2]);
        for (lanes, settings) in everywhere() {
            let (mut batch, lane) = batch_of(&fabric, lanes, Drive::NONE);
            batch.begin_tick(TICK, settings);
            assert!(batch.particles_mut(lane).is_none(), "no substep is under way");
            batch.integrate();
            let mut particles = batch.particles_mut(lane).expect("a cloth");
            let step = particles.effective_step();
            assert!(step > 0.0 && step <= TICK / settings.substeps as f32);
            for at in 0..particles.count() {
                let inverse_mass = particles.inverse_mass(at);
                let area = fabric.particle_areas()[at];
                let mass = FabricMaterial::COTTON.area_density * area;
                let pinned = fabric.is_pinned(at);
                let right = if pinned { 0.0 } else { 1.0 / mass };
                assert!(inverse_mass <= right * 1.001 && (inverse_mass == 0.0) == pinned);
                particles.set_position(at, Vec3::ONE);
                particles.add_acceleration(at, Vec3::ONE);
                particles.add_velocity(at, Vec3::ONE);
                if pinned {
                    assert_eq!(particles.position(at), fabric.rest_positions()[at]);
                    assert_eq!(particles.velocity(at), Vec3::ZERO);
                }
            }
            batch.update_velocities();
            assert!(batch.particles_mut(lane).is_none());
            assert!(batch.particles_mut(batch.lane_count()).is_none());
        }
    }
}
