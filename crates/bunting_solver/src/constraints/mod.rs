//! Constraints, one file each, with the same verb: `solve_x` projects every constraint of its kind
//! once, colour by colour.
//!
//! A constraint C(x) = 0 of stiffness k moves its particles by Δx = w ∇C Δλ with
//! Δλ = −(C + α̃ λ)/(Σ w |∇C|² + α̃), α̃ = 1/(k h²) (XPBD, Macklin 2016, eq. 18; with α̃ = 0 the
//! thesis's eq. 4.13 and 4.14). Inverse masses are w/σ with w one over the particle's area, so all
//! of it is multiplied through by the density σ: the compliances here are σ/(k h²).

mod contact;
mod dihedral;
mod distance;

use crate::lane_batch::LaneBatch;
use crate::lanes::Pack;

impl<P: Pack> LaneBatch<P> {
    /// Projects all constraints, as many passes as the settings ask for.
    pub fn solve_constraints(&mut self) {
        // A multiplier is worth keeping only if another pass reads it.
        let accumulate = self.clock.settings.passes > 1;
        if accumulate {
            self.link_multiplier.fill(P::splat(0.0));
            self.hinge_multiplier.fill(P::splat(0.0));
        }
        for _ in 0..self.clock.settings.passes {
            self.solve_dihedral(accumulate);
            self.solve_distance(accumulate);
            self.solve_contacts();
        }
    }
}
