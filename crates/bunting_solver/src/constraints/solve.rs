//! The order in which constraints are solved in a substep.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Positions};
use crate::batch::side_by_side::SideBySide;
use crate::batch::single_cloth::SingleCloth;
use crate::simd::lane::Pack;
use crate::step::Scheme;

impl<P: Pack> LaneBatch<P, SideBySide<P>> {
    /// Projects the predicted positions onto all constraints.
    pub fn solve_constraints(&mut self) {
        if self.clock.stands_still() {
            return;
        }
        match self.clock.settings.scheme {
            Scheme::GaussSeidel => self.solve_gauss_seidel(),
            Scheme::Yarns => {
                if self.fabric.grid().is_some() {
                    self.solve_bending_with_prediction();
                } else {
                    self.solve_dihedral(false);
                }
                self.solve_stretch_and_contacts();
            }
        }
    }
}

impl<P: Pack> LaneBatch<P, SingleCloth<P>> {
    /// Projects the predicted positions onto all constraints. The cloth is a grid, and the scheme that of yarns.
    pub fn solve_constraints(&mut self) {
        if !self.clock.stands_still() {
            self.solve_bending_with_prediction();
            self.solve_stretch_and_contacts();
        }
    }
}

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Solves stretch and contacts after bending, since stretch is the stiffer: chains, tethers, and for every
    /// second pass a sweep over warp and weft.
    fn solve_stretch_and_contacts(&mut self) {
        let passes = self.clock.settings.passes;
        self.solve_chains(passes);
        self.solve_tethers();
        for _ in 0..passes / 2 {
            self.sweep_links();
        }
        // Takes the positions back from the constraints.
        self.positions.packs_mut();
        self.update_prediction();
        self.solve_contacts();
    }
}
