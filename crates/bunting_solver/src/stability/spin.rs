//! Angular momentum of a free cloth on which nothing acts from outside.
//!
//! No internal force changes it, but a substep does, by two small errors. Each solve of a constraint moves particles
//! along the directions between them, and so has no moment, but later solves find particles that earlier ones have
//! moved, as about a [pole](crate::stability::pole). And the integrator damps vibrations together with their share of
//! the angular momentum. A rigid turn about the centre of mass gives back what a substep has lost: of all motions
//! with this angular momentum it has the least energy.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::lane_state::LaneState;
use crate::batch::layout::{Layout, Positions};
use crate::simd::constant::Constant;
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::{Pack3, V3};
use crate::stability::disturbance::Disturbance;
use crate::step::parameters::ParameterInputs;
use crate::step::rigid_motion::RigidMotion;

impl LaneState {
    /// Whether anything but gravity, which has no moment, acts on a cloth without pins in this substep.
    pub fn is_disturbed(&self, inputs: &ParameterInputs) -> bool {
        let is_pushed = self.inner_air.as_ref().is_some_and(|inner| !inner.is_closed());
        inputs.air_density != 0.0
            || inputs.material.damping != 0.0
            || is_pushed
            || self.is_acted_on()
    }

    fn keeps_spin(&self) -> bool {
        self.history.disturbance == Disturbance::default()
    }
}

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Something outside of the cloth may act on its particles in this substep.
    pub fn disturb(&mut self, cloth: usize) {
        if let Some(state) = &mut self.lanes[cloth] {
            state.history.disturbance.disturb();
        }
    }

    /// Gives back the angular momentum that the substep has lost, to free cloths on which nothing acts.
    pub fn keep_spin(&mut self) {
        if self.fabric.has_pins() {
            return;
        }
        let mut keeps = P::splat(0.0);
        for (cloth, state) in self.lanes.iter().enumerate() {
            if state.as_ref().is_some_and(|state| state.keeps_spin()) {
                keeps.lanes_mut()[Y::lanes(cloth)].fill(1.0);
            }
        }
        if keeps.lanes().contains(&1.0) {
            P::run(KeepSpin {
                keeps: &keeps,
                area: &self.numbers.area,
                areas: &self.masses.areas,
                partial_sums: &self.partial_sums,
                start: (&self.scratch, &self.older_velocity),
                position: self.positions.packs(),
                velocity: &mut self.velocity,
            });
        }
    }
}

struct KeepSpin<'a, P: Pack, C> {
    /// 1 in lanes whose cloth keeps its angular momentum, otherwise 0.
    keeps: &'a P,
    /// Area of each whole cloth, m².
    area: &'a P,
    areas: &'a [C],
    partial_sums: &'a [u8],
    /// Positions, m, and velocities, m/s, at the start of the substep.
    start: (&'a [Pack3<P>], &'a [Pack3<P>]),
    position: &'a [Pack3<P>],
    velocity: &'a mut [Pack3<P>],
}

impl<P: Pack, C: Constant<P>> Kernel<P> for KeepSpin<'_, P, C> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let per_area = L::splat(token, 1.0) / L::load(token, self.area);
        let masses = (self.areas, self.partial_sums);
        let before = RigidMotion::<L>::of(token, per_area, masses, self.start.0, self.start.1);
        let after = RigidMotion::<L>::of(token, per_area, masses, self.position, &*self.velocity);
        let turning = after.turning(token, before.spin - after.spin);
        let keeps = L::splat(token, 0.0).lt(L::load(token, self.keeps));
        for (position, velocity) in self.position.iter().zip(self.velocity) {
            let v: V3<L> = V3::load(token, velocity);
            let turned = v + turning.cross(V3::load(token, position) - after.centre);
            turned.or_where_not(keeps, v).store(velocity);
        }
    }
}
