//! The first phase of a substep: from the state at its start to predicted positions.

use core::mem::swap;

use crate::batch::lane_batch::LaneBatch;
use crate::batch::lane_state::LaneState;
use crate::batch::layout::{Layout, Positions};
use crate::constants::GRAVITY;
use crate::fabric::FabricMaterial;
use crate::simd::lane::Pack;
use crate::step::Scheme;
use crate::step::bdf::MotionSums;
use crate::step::predict::Predict;

/// Pressure of a wind that counts as none, in units of the weight of the cloth. Larger: implicit drag takes a part of the
/// wind's push on cloth that is at rest.
const NO_WIND: f32 = 0.01;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Begins a substep: transforms the state into the moved frame, applies air, damping and gravity, and
    /// predicts positions.
    pub fn integrate(&mut self) {
        if self.clock.stands_still() {
            return;
        }
        self.begin_substep();
        if self.parameters.any_frame_moved {
            self.carry_state();
        }
        let sums = self.predict_particles();
        self.clock.begun += 1;
        self.clock.predicted = true;
        self.assess_motion(&sums);
    }

    /// Predicts the particles, and sums their motion.
    fn predict_particles(&mut self) -> MotionSums<P> {
        self.move_pins();
        self.free_held();
        self.shelter_canopies();
        let feels_air = self.parameters.any_feels_air();
        if feels_air {
            self.gather_air();
            self.sum_air_on_pins();
        }
        let sums = self.predict(feels_air);
        self.push_by_air();
        self.draw_held();
        sums
    }

    /// Predicts positions and velocities, and sums the squares of velocities and of their differences. The
    /// newest values overwrite the oldest arrays, and the arrays swap their names.
    pub(super) fn predict(&mut self, feels_air: bool) -> MotionSums<P> {
        let zero = P::splat(0.0);
        let mut sums =
            MotionSums { velocity: zero, first_difference: zero, second_difference: zero };
        P::run(Predict {
            areas: &self.masses.areas,
            inverse_areas: &self.masses.inverse_areas,
            inverse_masses: &self.masses.inverse,
            partial_sums: &self.partial_sums,
            pole: self.numbers.pole.as_ref(),
            parameters: &self.parameters,
            frame_rate: -1.0 / self.clock.step,
            position: self.positions.packs(),
            next: &mut self.scratch,
            displacement: &self.displacement,
            older_displacement: &mut self.older_displacement,
            velocity: &mut self.velocity,
            older_velocity: &mut self.older_velocity,
            oldest_velocity: &mut self.oldest_velocity,
            feels_air,
            sums: &mut sums,
        });
        swap(self.positions.packs_mut(), &mut self.scratch);
        swap(&mut self.velocity, &mut self.oldest_velocity);
        swap(&mut self.older_velocity, &mut self.oldest_velocity);
        swap(&mut self.displacement, &mut self.older_displacement);
        sums
    }

    /// Restarts the integrator of cloths whose motion is rough, and finds which cloths are near rest.
    fn assess_motion(&mut self, sums: &MotionSums<P>) {
        let relaxes = self.clock.settings.scheme == Scheme::Yarns;
        let particles = self.fabric.particle_count();
        for cloth in 0..self.lanes.len() {
            let Some(state) = &mut self.lanes[cloth] else { continue };
            let sums = sums.of_lane(Y::lanes(cloth).start);
            let is_free = state.is_free_of_wind_and_colliders();
            let near_rest = relaxes && state.history.assess_rest(sums, particles, is_free);
            state.history.restart_if_rough(sums, particles);
            if self.parameters.is_near_rest(Y::lanes(cloth)) && !near_rest {
                self.reset_relaxation(cloth);
            }
            self.parameters.set_near_rest(Y::lanes(cloth), near_rest);
        }
    }
}

impl LaneState {
    /// Whether no wind pushes the cloth, and no collider may touch it in this tick.
    fn is_free_of_wind_and_colliders(&self) -> bool {
        let FabricMaterial { area_density, pressure_coefficient, friction_coefficient, .. } =
            self.material;
        let coefficient = pressure_coefficient + friction_coefficient;
        let squared = self.drive.wind.length_squared();
        let pressure = 0.5 * self.drive.air_density * coefficient * squared;
        pressure <= NO_WIND * area_density * GRAVITY
            && self.local_wind.is_none()
            && self.contacts.iter().all(|candidates| candidates.is_empty())
    }
}
