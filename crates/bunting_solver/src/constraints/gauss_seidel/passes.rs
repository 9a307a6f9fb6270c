//! Passes over all constraints of the Gauss–Seidel scheme.

use crate::batch::lane_batch::LaneBatch;
use crate::simd::lane::Pack;

impl<P: Pack> LaneBatch<P> {
    /// Solves bending, stretch and contacts once in each pass of the settings.
    pub fn solve_gauss_seidel(&mut self) {
        let passes = self.clock.settings.passes;
        let links = self.fabric.links().len();
        self.link_target.resize(self.link_target.len().max(links), P::splat(0.0));
        // With a single pass no later pass reads the multipliers.
        let accumulate = passes > 1;
        if accumulate {
            for (target, link) in self.link_target.iter_mut().zip(self.fabric.links()) {
                *target = P::splat(link.rest_length);
            }
            self.layout.hinge_multiplier.fill(P::splat(0.0));
        }
        for pass in 1..=passes {
            self.solve_dihedral(accumulate);
            self.solve_distance(accumulate);
            if pass == passes {
                self.sum_reactions();
            }
            self.solve_guides();
            self.solve_contacts();
        }
    }
}
