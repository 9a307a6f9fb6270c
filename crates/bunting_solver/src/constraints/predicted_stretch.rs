//! Stiff bending solved at the positions that stretch is predicted to lead to.
//!
//! Bending is solved before stretch, at positions that gravity has moved and stretch is yet to move back. For
//! limp cloth that does not matter; a stiff strip is bent by the detour: at Γ = 50 the heavy cantilever droops
//! 1.8 % too far with three substeps. Therefore the displacement by stretch in past substeps is kept as an
//! acceleration, and added while bending is solved.
//!
//! Displacements by diagonals are left out. The motion of a cloth in its own plane, against its shear, is slow
//! and pushes each row of a narrow strip to and fro: with a prediction of it the strip's rows drifted apart
//! sideways for ever. Where cells are so long that diagonals count as warp or weft, the two cannot be told
//! apart, and nothing is predicted.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Positions};
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::{Pack3, V3};
use crate::step::parameters::Parameters;

/// Part of the prediction that is replaced in each substep. Larger: an oscillation of stretch is predicted, too.
/// Smaller: the prediction follows slowly.
const RENEWED: f32 = 0.5;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Solves bending and twist with positions shifted by the predicted stretch.
    pub fn solve_bending_with_prediction(&mut self) {
        if !self.predicts_stretch() {
            self.solve_bending();
            self.solve_twist();
            return;
        }
        self.shift_by_prediction(1.0);
        self.solve_bending();
        self.solve_twist();
        self.shift_by_prediction(-1.0);
        self.bent_position.copy_from_slice(self.positions.packs());
    }

    /// Renews the prediction by the displacement by stretch in this substep.
    pub fn update_prediction(&mut self) {
        if self.predicts_stretch() {
            P::run(UpdatePrediction {
                parameters: &self.parameters,
                position: self.positions.packs(),
                bent_position: &self.bent_position,
                predicted: &mut self.predicted_stretch,
            });
        }
    }

    /// Leaves displacements between two calls, the first with `sign` −1 and the second with 1, out of the
    /// prediction: the positions after bending are displaced alike.
    pub fn leave_out_of_prediction(&mut self, sign: f32) {
        if self.predicts_stretch() {
            P::run(LeaveOut {
                sign,
                position: self.positions.packs_mut(),
                bent_position: &mut self.bent_position,
            });
        }
    }

    fn predicts_stretch(&self) -> bool {
        self.parameters.predicted_part.lanes().iter().any(|&part| part > 0.0)
    }

    fn shift_by_prediction(&mut self, sign: f32) {
        P::run(Shift {
            parameters: &self.parameters,
            sign,
            position: self.positions.packs_mut(),
            predicted: &self.predicted_stretch,
        });
    }
}

struct Shift<'a, P: Pack> {
    parameters: &'a Parameters<P>,
    sign: f32,
    position: &'a mut [Pack3<P>],
    predicted: &'a [Pack3<P>],
}

impl<P: Pack> Kernel<P> for Shift<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let step = L::load(token, &self.parameters.step);
        let part = L::load(token, &self.parameters.predicted_part);
        let scale = step * step * part * L::splat(token, self.sign);
        let predicts = L::splat(token, 0.0).lt(part);
        for (position, predicted) in self.position.iter_mut().zip(self.predicted) {
            let x: V3<L> = V3::load(token, position);
            let shifted = x + V3::load(token, predicted) * scale;
            shifted.or_where_not(predicts, x).store(position);
        }
    }
}

struct LeaveOut<'a, P: Pack> {
    sign: f32,
    position: &'a [Pack3<P>],
    bent_position: &'a mut [Pack3<P>],
}

impl<P: Pack> Kernel<P> for LeaveOut<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let sign = L::splat(token, self.sign);
        for (bent, position) in self.bent_position.iter_mut().zip(self.position) {
            let from: V3<L> = V3::load(token, bent);
            from.plus_scaled(V3::load(token, position), sign).store(bent);
        }
    }
}

struct UpdatePrediction<'a, P: Pack> {
    parameters: &'a Parameters<P>,
    position: &'a [Pack3<P>],
    bent_position: &'a [Pack3<P>],
    predicted: &'a mut [Pack3<P>],
}

impl<P: Pack> Kernel<P> for UpdatePrediction<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let rate = L::load(token, &self.parameters.inverse_step);
        let renewed = L::splat(token, RENEWED);
        let positions = self.position.iter().zip(self.bent_position);
        for ((position, bent), predicted) in positions.zip(self.predicted) {
            let moved: V3<L> = V3::load(token, position) - V3::load(token, bent);
            let old: V3<L> = V3::load(token, predicted);
            (old + (moved * (rate * rate) - old) * renewed).store(predicted);
        }
    }
}
