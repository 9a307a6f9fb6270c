//! The push of the air inside cloths on their particles.

use glam::Vec3;

use crate::batch::lane_batch::LaneBatch;
use crate::batch::lane_state::LaneState;
use crate::batch::layout::{Layout, Positions};
use crate::pressure::air::Pressure;
use crate::pressure::state::LanePressure;
use crate::simd::lane::Pack;
use crate::simd::vec3::{lane3, set_lane3, splat3};

/// Greatest τ² T/(σ l²) of a cloth that air draws taut with a tension T, with l the distance of its particles and τ the effective length of
/// the substep. Larger: with five times as much a ball bursts, since the directions of its links are frozen in a substep. Smaller: a ball at
/// half the substeps that it needs is softer than it could be.
const MOST_TENSION: f32 = 0.6;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Adds the push of the air inside cloths to the predicted velocities and positions, as gravity is.
    pub(crate) fn push_by_air(&mut self) {
        if self.lanes.iter().flatten().all(|state| state.inner_air.is_none()) {
            return;
        }
        self.measure_air();
        for cloth in 0..self.lanes.len() {
            self.with_air(cloth, |batch, state, inner| {
                let step = batch.parameters.step.lanes()[Y::lanes(cloth).start];
                let most = batch.most_pressure(cloth, state, inner, step);
                let pressure = batch.pressure_of(cloth, state, inner, step).clamp(-most, most);
                state.history.pressure = Some(pressure);
                batch.push(cloth, inner, pressure / state.material.area_density * step);
            });
        }
        self.sum_inner_air_on_pins();
    }

    /// The greatest pressure that a substep of the effective length `step`, s, resolves, Pa.
    fn most_pressure(
        &self,
        cloth: usize,
        state: &LaneState,
        inner: &LanePressure,
        step: f32,
    ) -> f32 {
        let fabric = &self.fabric_of(cloth).fabric;
        let tension =
            MOST_TENSION * state.material.area_density * inner.spacing_squared / (step * step);
        let most = tension / inner.tension(fabric).max(f32::MIN_POSITIVE);
        most.min(f32::MAX)
    }

    /// The pressure along the normals in a substep of the effective length `step`, s, Pa.
    fn pressure_of(&self, cloth: usize, state: &LaneState, inner: &LanePressure, step: f32) -> f32 {
        match inner.air {
            Pressure::Constant { pressure } => pressure,
            Pressure::Sealed { pressure, ambient } => {
                let yielding =
                    self.yielding(cloth, inner) * step * step / state.material.area_density;
                inner.sealed(pressure, ambient, yielding)
            }
            Pressure::Canopy { coefficient } => {
                let slowing = self.yielding(cloth, inner) * step / state.material.area_density;
                self.trapped(cloth, state, inner, coefficient, slowing)
            }
        }
    }

    /// Σ w |S|², with the inverse masses w per area density: times the inverse of that, it is by how much a unit of pressure
    /// accelerates the growth of the volume, m².
    fn yielding(&self, cloth: usize, inner: &LanePressure) -> f32 {
        let of = |(particle, gradient): (usize, &Vec3)| {
            let (pack, lane) = self.layout.locate(particle, cloth);
            self.masses.inverse[pack].lanes()[lane] * gradient.length_squared()
        };
        inner.gradient.iter().enumerate().map(of).sum()
    }

    /// Adds a push along the gradients to a cloth, given the pressure times the length of the substep over the area
    /// density, m/s.
    fn push(&mut self, cloth: usize, inner: &LanePressure, rate: f32) {
        let step = self.parameters.step.lanes()[Y::lanes(cloth).start];
        for (particle, &gradient) in inner.gradient.iter().enumerate() {
            let (pack, lane) = self.layout.locate(particle, cloth);
            let change = gradient * (self.masses.inverse[pack].lanes()[lane] * rate);
            let velocity = &mut self.velocity[pack];
            set_lane3(velocity, lane, lane3(velocity, lane) + change);
            self.shift_prediction(pack, lane, change * step);
        }
    }

    /// Computes the gradients of all cloths with air at the predicted positions.
    fn measure_air(&mut self) {
        let mut packs = core::mem::take(&mut self.gradient);
        packs.resize(self.layout.pack_count(), splat3(Vec3::ZERO));
        self.sum_gradient(&mut packs);
        self.positions.packs_mut();
        for cloth in 0..self.lanes.len() {
            let inner = self.lanes[cloth].as_mut().and_then(|state| state.inner_air.take());
            let Some(mut inner) = inner else { continue };
            self.layout.read(&packs, cloth, &mut inner.gradient);
            self.layout.read(self.positions.packs(), cloth, &mut inner.positions);
            inner.close();
            if let Some(state) = &mut self.lanes[cloth] {
                state.inner_air = Some(inner);
            }
        }
        self.gradient = packs;
    }

    /// Calls `act` with a cloth that has air, and its air. Its state is taken out, so that the batch can be written.
    pub(super) fn with_air(
        &mut self,
        cloth: usize,
        act: impl FnOnce(&mut Self, &mut LaneState, &LanePressure),
    ) {
        let has_air = |state: &mut LaneState| state.inner_air.is_some();
        let Some(mut state) = self.lanes[cloth].take_if(has_air) else { return };
        if let Some(inner) = state.inner_air.take() {
            act(self, &mut state, &inner);
            state.inner_air = Some(inner);
        }
        self.lanes[cloth] = Some(state);
    }
}
