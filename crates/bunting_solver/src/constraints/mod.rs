//! Constraints, one file each, with the same verb: `solve_x` projects every constraint of its kind
//! once, colour by colour.
//!
//! A constraint C(x) = 0 of stiffness k moves its particles by Δx = w ∇C Δλ with
//! Δλ = −(C + α̃ λ)/(Σ w |∇C|² + α̃), α̃ = 1/(k h²) (XPBD, Macklin 2016, eq. 18; with α̃ = 0 the
//! thesis's eq. 4.13 and 4.14). Inverse masses are w/σ with w one over the particle's area, so all
//! of it is multiplied through by the density σ: the compliances here are σ/(k h²).

#[cfg(test)]
mod bench;
mod bending;
mod chain;
mod dihedral;
mod distance;
mod predicted_stretch;
mod shear;
mod sweep;
mod tether;
mod twist;

pub(crate) use chain::Knot;
pub(crate) use predicted_stretch::anticipated;
pub(crate) use twist::resists_twist;

use crate::batch::lane_batch::LaneBatch;
use crate::batch::places::Constant;
use crate::simd::lane::Pack;
use crate::step::Scheme;

impl<P: Pack, C: Constant<P>> LaneBatch<P, C> {
    /// Projects all constraints, as many passes as the settings ask for.
    pub fn solve_constraints(&mut self) {
        if self.clock.stands_still() {
            return;
        }
        match self.clock.settings.scheme {
            Scheme::GaussSeidel => self.sweep(self.clock.settings.passes),
            Scheme::Yarns => self.solve_along_yarns(self.clock.settings.passes),
        }
    }

    /// The thesis's relaxation: one constraint after the other, over and over.
    fn sweep(&mut self, passes: u32) {
        // What a pass has found is worth keeping only if another reads it.
        let accumulate = passes > 1;
        if accumulate {
            for (target, link) in self.link_target.iter_mut().zip(self.fabric.links()) {
                *target = P::splat(link.rest_length);
            }
            self.hinge_multiplier.fill(P::splat(0.0));
        }
        for _ in 0..passes {
            self.solve_dihedral(accumulate);
            self.solve_distance(accumulate);
            self.solve_contacts();
        }
    }

    /// Bending first, for stretch is the stiffer; then yarns, tethers, and for every second pass a
    /// sweep over warp and weft, which takes off what the yarns' frozen directions overshoot.
    fn solve_along_yarns(&mut self, passes: u32) {
        if self.fabric.grid().is_some() {
            self.solve_bending_with_anticipation();
        } else {
            self.solve_dihedral(false);
        }
        self.solve_yarns(passes);
        self.solve_tethers();
        for _ in 0..passes / 2 {
            self.polish();
        }
        self.unravel();
        self.remember_stretch();
        self.solve_contacts();
    }
}
