//! The chains of nets, in an order that reads the same backwards.
//!
//! With two passes it is W F | D | F W F | D' | F W, where D' are the diagonals backwards. Then the passes are self-adjoint, and create
//! no energy (`solve.rs`). With W F after each D a torus trembled for ever, at 240 mm/s at 2 × 2, and trousers that a jerk had pulled at
//! 600 mm/s at 8 × 2. Grids, whose warp, weft and shear hardly act on one another, have the shorter order W F | D | W F | W F.
//!
//! A line that ends at a border gives its load to its neighbours by shear. Diagonals that are solved once carry that load over one
//! row in a substep: a stiff disk that hangs from a chord sinks by 37 % too far, a pennant by 87 %. Therefore they are solved in
//! each pass. Their tension is kept from pass to pass, as that of warp and weft is, in their targets, which are computed in each substep
//! (`shear.rs`).

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::Layout;
use crate::constraints::chain::Pass;
use crate::constraints::direction::sweep_order;
use crate::fabric::LinkFamily;
use crate::simd::lane::Pack;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Solves warp and weft, then diagonals, and warp and weft to and fro, in each pass.
    pub(super) fn solve_lines_both_ways(&mut self, passes: u32) {
        self.solve_warp_and_weft(Pass::First);
        self.find_diagonal_targets();
        self.solve_passes_both_ways(passes);
    }

    /// Solves diagonals, and warp and weft backwards, in each pass after the first solution of warp and weft.
    pub(super) fn solve_passes_both_ways(&mut self, passes: u32) {
        let colours = 0..self.colour_count();
        let is_diagonal = |family| family == LinkFamily::Diagonal;
        let is_straight = |family| family != LinkFamily::Diagonal;
        for pass in 0..passes {
            if pass > 0 {
                // The pass before ended with the first colour.
                self.solve_colours(colours.clone().skip(1), Pass::Again, is_straight);
            }
            let diagonals = sweep_order(colours.len(), !pass.is_multiple_of(2));
            self.solve_colours(diagonals, Pass::Again, is_diagonal);
            self.solve_colours(colours.clone().rev(), Pass::Again, is_straight);
            self.solve_contacts_of_pass();
        }
    }
}
