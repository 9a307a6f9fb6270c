//! Corrections of a mesh, summed by themselves.
//!
//! A mesh's particle is corrected some forty times in a substep, by each of its hinges and chains, twice. Added to
//! its position one by one, these corrections would each be rounded to a unit in the last place of the position,
//! 3 × 10⁻⁸ m for a third of a metre, and become velocities of 2 × 10⁻⁵ m/s at 480 substeps a second, which add up
//! like a random walk: free meshes at rest moved at 10 mm/s after half a minute. Summed by themselves they are
//! rounded to a unit in the last place of their sum. The position is rounded once, at the end, and what that
//! rounding leaves out becomes velocity all the same.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Particles, Positions};
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::{Pack3, V3};
use crate::step::parameters::Parameters;

impl<P: Pack> LaneBatch<P> {
    /// Begins to sum corrections.
    pub(super) fn sum_corrections(&mut self) {
        self.correction.clear();
        self.correction.resize(self.positions.packs().len(), [P::splat(0.0); 3]);
        self.begin_lone_mesh();
    }

    /// Adds the sums of corrections to the positions.
    pub(super) fn apply_corrections(&mut self) {
        self.end_lone_mesh();
        P::run(ApplyCorrections {
            parameters: &self.parameters,
            correction: &self.correction,
            position: self.positions.packs_mut(),
            velocity: &mut self.velocity,
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

struct ApplyCorrections<'a, P: Pack> {
    parameters: &'a Parameters<P>,
    /// Sums of the corrections, m.
    correction: &'a [Pack3<P>],
    position: &'a mut [Pack3<P>],
    /// Predicted velocities, m/s. The part of the corrections that the rounding of positions leaves out is added to
    /// them.
    velocity: &'a mut [Pack3<P>],
}

impl<P: Pack> Kernel<P> for ApplyCorrections<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let inverse_step = L::load(token, &self.parameters.inverse_step);
        let particles = self.position.iter_mut().zip(self.velocity);
        for ((position, velocity), correction) in particles.zip(self.correction) {
            let x: V3<L> = V3::load(token, position);
            let correction = V3::load(token, correction);
            let corrected = x + correction;
            corrected.store(position);
            let left_out = correction - (corrected - x);
            let v: V3<L> = V3::load(token, velocity);
            v.plus_scaled(left_out, inverse_step).store(velocity);
        }
    }
}
