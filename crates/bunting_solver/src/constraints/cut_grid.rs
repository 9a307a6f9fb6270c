//! The chains of a grid that the border of a mesh cuts.
//!
//! Where yarns end at the border, they give their load to their neighbours by shear, which warp and weft and diagonals that are solved
//! once would carry over one row in a substep: a disk that hangs from a chord sinks by 37 % too far, a pennant by 87 %.
//! Therefore the diagonals are solved in each pass, too. Their tension is kept from pass to pass, as that of warp and weft is, in
//! their targets, which hold for the whole tick and are put back afterwards.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::Layout;
use crate::constraints::chain::Pass;
use crate::fabric::LinkFamily;
use crate::simd::lane::Pack;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Solves diagonals, and warp and weft, in each pass after the first solution of warp and weft.
    pub(super) fn solve_passes_of_cut_grid(&mut self, passes: u32) {
        self.targets_of_tick.clone_from(&self.link_target);
        for _ in 0..passes {
            self.solve_colours(Pass::Again, |family| family == LinkFamily::Diagonal);
            self.solve_warp_and_weft(Pass::Again);
        }
        let chains = self.layout.chains(&self.fabric);
        let colours = chains.colours.iter().filter(|it| it.family == LinkFamily::Diagonal);
        for pair in colours.flat_map(|colour| &chains.pairs[colour.pairs.clone()]) {
            let targets = &self.targets_of_tick[pair.targets.clone()];
            self.link_target[pair.targets.clone()].copy_from_slice(targets);
        }
    }
}
