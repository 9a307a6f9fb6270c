//! The chains of grids that are curved or that the border of a mesh cuts, and of nets, in an order that reads the same backwards.
//!
//! With two passes it is W F | D | F W F | D' | F W, where D' are the diagonals backwards. Then the passes are self-adjoint, and create
//! no energy (`solve.rs`). With W F after each D a torus trembled for ever, at 240 mm/s at 2 × 2, and trousers that a jerk had pulled at
//! 600 mm/s at 8 × 2. Flat grids, whose warp, weft and shear hardly act on one another, have the shorter order W F | D | W F | W F.
//!
//! A yarn that ends at the border gives its load to its neighbours by shear. Diagonals that are solved once carry that load over one
//! row in a substep: a stiff disk that hangs from a chord sinks by 37 % too far, a pennant by 87 %. Therefore they are solved in
//! each pass. Their tension is kept from pass to pass, as that of warp and weft is, in their targets, which are computed in each substep
//! (`shear.rs`). Cut grids, whose yarns end at a border, have one pass more than asked for, and the last two are extrapolated
//! (`extrapolation.rs`).
//!
//! Bending, passes, tethers and sweep are four groups, and the product of three and more has complex eigenvalues again, even if each
//! is self-adjoint: nets that hung from one vertex swung ever wider. Therefore every second substep solves the groups in the reverse
//! order, so that its circulatory forces are those of the substep before with the opposite sign. The order of the first substep of
//! a tick is tethers, passes, bending, sweep; that of the second is bending, passes, tethers, sweep. But for the place of the sweep,
//! which ends both, one is the reverse of the other, and the eigenvalues of a product are those of its factors in cyclic order.
//! Where tethers come first, the sweep goes backwards, too: on cut grids over the colours and over the links of each, on other curved
//! grids over the links alone, on nets over the colours alone. This was chosen by measurement: where a net's sweep goes all
//! backwards, four nets of eighty tremble at 8 to 27 mm/s, and none as it is.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::Layout;
use crate::constraints::chain::Pass;
use crate::constraints::direction::sweep_order;
use crate::constraints::extrapolation::extrapolation_of;
use crate::fabric::LinkFamily;
use crate::simd::lane::Pack;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Whether the cloth is a curved or a cut grid, or a net.
    pub(super) fn is_solved_both_ways(&self) -> bool {
        self.fabric.is_cut() || self.fabric.rest_bends().is_some()
    }

    /// Whether this substep solves tethers, passes, bending and sweep in this order, as each tick's first, third and so on do.
    pub(super) fn begins_with_tethers(&self) -> bool {
        self.is_solved_both_ways() && !self.is_narrow() && !self.clock.begun.is_multiple_of(2)
    }

    /// Solves diagonals, and warp and weft backwards, in each pass after the first solution of warp and weft.
    pub(super) fn solve_passes_both_ways(&mut self, passes: u32) {
        let colours = 0..self.colour_count();
        let is_diagonal = |family| family == LinkFamily::Diagonal;
        let is_straight = |family| family != LinkFamily::Diagonal;
        let is_cut_grid = self.fabric.is_cut_grid();
        let passes = passes + u32::from(is_cut_grid);
        for pass in 0..passes {
            let extrapolation = extrapolation_of(pass, passes).filter(|_| is_cut_grid);
            if extrapolation.is_some() {
                self.begin_extrapolation();
            }
            if pass > 0 {
                // The pass before ended with the first colour.
                self.solve_colours(colours.clone().skip(1), Pass::Again, is_straight);
            }
            let diagonals = sweep_order(colours.len(), !pass.is_multiple_of(2));
            self.solve_colours(diagonals, Pass::Again, is_diagonal);
            self.solve_colours(colours.clone().rev(), Pass::Again, is_straight);
            if let Some(factor) = extrapolation {
                self.extrapolate(factor);
            }
        }
    }
}
