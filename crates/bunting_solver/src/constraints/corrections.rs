//! Corrections of a mesh, summed by themselves, and what rounding leaves out of its positions.
//!
//! A mesh's particle is corrected some forty times in a substep, by each of its hinges and yarns, twice. Added to
//! its position one by one, these corrections would each be rounded to a unit in the last place of the position,
//! 3 × 10⁻⁸ m for a third of a metre, and become velocities of 2 × 10⁻⁵ m/s at 480 substeps a second, which add up
//! like a random walk: free meshes at rest moved at 10 mm/s after half a minute. Summed by themselves they are
//! rounded to a unit in the last place of their sum.
//!
//! When the sum is added to the position, what rounding leaves out stays in the sum (compensated summation, Kahan
//! 1965), and so does what rounding leaves out of the prediction. Else positions would wander from the displacements
//! that the integrator extrapolates, by a random walk again: 1.6 mm/s after half a minute.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Particles, Positions};
use crate::simd::constant::Constant;
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::{Pack3, V3};
use crate::step::parameters::Parameters;
use crate::step::predict::ROUNDING;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Begins to sum corrections in a substep, with what rounding has left out of the predicted positions.
    pub fn begin_corrections(&mut self) {
        P::run(BeginCorrections {
            inverse_areas: &self.masses.inverse_areas,
            predicted: self.positions.packs(),
            start: &self.scratch,
            displacement: &self.displacement,
            correction: &mut self.correction,
            predicted_correction: &mut self.predicted_correction,
        });
    }

    /// Ends the sum of corrections in a substep: adds to displacements and velocities what it has grown by, which the
    /// positions do not show.
    pub fn end_corrections(&mut self) {
        P::run(EndCorrections {
            parameters: &self.parameters,
            predicted_correction: &self.predicted_correction,
            correction: &self.correction,
            displacement: &mut self.displacement,
            velocity: &mut self.velocity,
        });
    }
}

impl<P: Pack> LaneBatch<P> {
    /// Adds the corrections to the positions, except for what rounding leaves out.
    pub(super) fn apply_corrections(&mut self) {
        self.end_lone_mesh();
        P::run(ApplyCorrections {
            correction: &mut self.correction,
            position: self.positions.packs_mut(),
        });
    }
}

/// Particles of a mesh while corrections are summed.
pub(super) struct CorrectedParticles<'a, P: Pack> {
    pub inverse_masses: &'a [P],
    /// Positions before the corrections, m.
    pub predicted: &'a [Pack3<P>],
    /// Sums of the corrections, m.
    pub correction: &'a mut [Pack3<P>],
}

impl<P: Pack> Particles<P> for CorrectedParticles<'_, P> {
    type Constant = f32;

    #[inline(always)]
    fn position<L: Lane<Pack = P>>(&self, token: L::Token, at: u32) -> V3<L> {
        let at = at as usize;
        V3::load(token, &self.predicted[at]) + V3::load(token, &self.correction[at])
    }

    #[inline(always)]
    fn set_position<L: Lane<Pack = P>>(&mut self, token: L::Token, at: u32, position: V3<L>) {
        let at = at as usize;
        (position - V3::load(token, &self.predicted[at])).store(&mut self.correction[at]);
    }

    #[inline(always)]
    fn correct<L: Lane<Pack = P>>(
        &mut self,
        token: L::Token,
        at: u32,
        _: V3<L>,
        (direction, factor): (V3<L>, L),
    ) {
        let sum = &mut self.correction[at as usize];
        V3::<L>::load(token, sum).plus_scaled(direction, factor).store(sum);
    }

    #[inline(always)]
    fn inverse_mass<L: Lane<Pack = P>>(&self, token: L::Token, at: u32) -> L {
        L::load(token, &self.inverse_masses[at as usize])
    }

    #[inline(always)]
    fn one_if_linked<L: Lane<Pack = P>>(&self, token: L::Token, _: u32) -> L {
        L::splat(token, 1.0)
    }
}

struct BeginCorrections<'a, P: Pack, C> {
    inverse_areas: &'a [C],
    predicted: &'a [Pack3<P>],
    /// Positions at the start of the substep, m.
    start: &'a [Pack3<P>],
    /// Predicted displacements, m.
    displacement: &'a [Pack3<P>],
    correction: &'a mut [Pack3<P>],
    predicted_correction: &'a mut [Pack3<P>],
}

impl<P: Pack, C: Constant<P>> Kernel<P> for BeginCorrections<'_, P, C> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let (zero, rounding) = (V3::splat(token, 0.0), V3::splat(token, ROUNDING));
        let sums = self.correction.iter_mut().zip(self.predicted_correction);
        let moves = self.predicted.iter().zip(self.start).zip(self.displacement);
        for (((predicted, start), displacement), ((correction, of_predicted), inverse_area)) in
            moves.zip(sums.zip(self.inverse_areas))
        {
            let moved: V3<L> = V3::load(token, predicted) - V3::load(token, start);
            let left_out = V3::load(token, displacement) - moved;
            let sum: V3<L> = V3::load(token, correction) + left_out;
            let sum = inverse_area.select3(token, (sum + rounding) - rounding, zero);
            sum.store(correction);
            sum.store(of_predicted);
        }
    }
}

struct ApplyCorrections<'a, P: Pack> {
    correction: &'a mut [Pack3<P>],
    position: &'a mut [Pack3<P>],
}

impl<P: Pack> Kernel<P> for ApplyCorrections<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        for (position, correction) in self.position.iter_mut().zip(self.correction) {
            let x: V3<L> = V3::load(token, position);
            let by = V3::load(token, correction);
            let corrected = x + by;
            corrected.store(position);
            (by - (corrected - x)).store(correction);
        }
    }
}

struct EndCorrections<'a, P: Pack> {
    parameters: &'a Parameters<P>,
    predicted_correction: &'a [Pack3<P>],
    correction: &'a [Pack3<P>],
    displacement: &'a mut [Pack3<P>],
    velocity: &'a mut [Pack3<P>],
}

impl<P: Pack> Kernel<P> for EndCorrections<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let inverse_step = L::load(token, &self.parameters.inverse_step);
        let sums = self.correction.iter().zip(self.predicted_correction);
        for ((correction, before), (displacement, velocity)) in
            sums.zip(self.displacement.iter_mut().zip(self.velocity))
        {
            let growth: V3<L> = V3::load(token, correction) - V3::load(token, before);
            growth.add_to(token, displacement);
            let v: V3<L> = V3::load(token, velocity);
            v.plus_scaled(growth, inverse_step).store(velocity);
        }
    }
}
