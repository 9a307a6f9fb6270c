//! Bending of stiff grids, solved at positions that already contain the displacement by stretch.
//!
//! Bending is solved before stretch, at positions that gravity has moved and stretch has not corrected yet.
//! Limp cloth is not affected, but a stiff strip is bent by this displacement: at Γ = 50 the heavy cantilever
//! droops 1.8 % too far with three substeps. Therefore stiff cloth goes through trials: bending and then warp
//! and weft are solved, the displacement by warp and weft is added to the predicted positions, bending is
//! solved there, and the displacement is subtracted again. This is a block Gauss–Seidel iteration on the
//! multipliers of both.
//!
//! Nothing is kept from substep to substep. A displacement from past substeps would be a feedback with a
//! delay of one substep and a gain near one around two projections that do not commute: with it narrow strips
//! oscillated for ever.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Order, Positions};
use crate::constraints::chain::Pass;
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::{Pack3, V3};
use crate::step::parameters::Parameters;

/// Number of trials in a substep. At Γ = 50 and two substeps a cantilever droops 0.1 % too far; with two
/// trials 0.2 %, with one 0.5 %. More trials: stiff cloth costs more.
const TRIALS: u32 = 3;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Solves bending and twist after stretch, whose tensions stay as they are: those of the trials are dropped.
    pub(super) fn solve_bends_of_taut_lines(&mut self) {
        let has_trials = self.parameters.any_bends_stiffly();
        if has_trials {
            self.targets_before_bending.clone_from(&self.link_target);
        }
        self.solve_all_bends();
        if has_trials {
            core::mem::swap(&mut self.link_target, &mut self.targets_before_bending);
        }
    }

    /// Solves bending and twist; for stiff cloth at positions that contain the displacement by stretch.
    pub(super) fn solve_all_bends(&mut self) {
        self.turn_rest_bends();
        if !self.parameters.any_bends_stiffly() {
            self.bend();
            return;
        }
        self.predicted_position.clone_from(self.positions.packs_mut());
        self.bend();
        for _ in 0..TRIALS {
            self.stretch_shift.clone_from(self.positions.packs_mut());
            self.solve_warp_and_weft(Pass::First);
            P::run(Shift {
                parameters: &self.parameters,
                predicted: &self.predicted_position,
                position: self.positions.packs_mut(),
                shift: &mut self.stretch_shift,
            });
            self.bend();
            P::run(ShiftBack {
                parameters: &self.parameters,
                position: self.positions.packs_mut(),
                shift: &self.stretch_shift,
            });
        }
    }

    /// Turns the second differences at rest of nets with the nodes at their present positions.
    fn turn_rest_bends(&mut self) {
        let Some(rest) = &mut self.rest_bends else { return };
        let (masses, linked) = (&self.masses.inverse, self.layout.linked());
        rest.turn(self.positions.particles(Order::RowMajor, masses, linked));
    }

    fn bend(&mut self) {
        self.solve_bending();
        self.solve_twist();
    }
}

/// Resets particles to their predicted positions, shifted in stiff lanes by the displacement by stretch.
struct Shift<'a, P: Pack> {
    parameters: &'a Parameters<P>,
    predicted: &'a [Pack3<P>],
    position: &'a mut [Pack3<P>],
    /// Before: positions before stretch, m. After: the displacement by stretch, m.
    shift: &'a mut [Pack3<P>],
}

impl<P: Pack> Kernel<P> for Shift<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let zero = L::splat(token, 0.0);
        let is_stiff = zero.lt(L::load(token, &self.parameters.bends_stiffly));
        let positions = self.position.iter_mut().zip(self.predicted);
        for ((position, predicted), shift) in positions.zip(self.shift) {
            let x: V3<L> = V3::load(token, predicted);
            let stretch = V3::load(token, position) - V3::load(token, shift);
            stretch.store(shift);
            (x + stretch).or_where_not(is_stiff, x).store(position);
        }
    }
}

/// Undoes the shift in stiff lanes.
struct ShiftBack<'a, P: Pack> {
    parameters: &'a Parameters<P>,
    position: &'a mut [Pack3<P>],
    shift: &'a [Pack3<P>],
}

impl<P: Pack> Kernel<P> for ShiftBack<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let zero = L::splat(token, 0.0);
        let is_stiff = zero.lt(L::load(token, &self.parameters.bends_stiffly));
        for (position, shift) in self.position.iter_mut().zip(self.shift) {
            let x: V3<L> = V3::load(token, position);
            (x - V3::load(token, shift)).or_where_not(is_stiff, x).store(position);
        }
    }
}
