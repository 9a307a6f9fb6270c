//! The chains of a grid that the border of a mesh cuts.
//!
//! A yarn that ends at the border gives its load to its neighbours by shear. Diagonals that are solved once carry that load over one
//! row in a substep: a stiff disk that hangs from a chord sinks by 37 % too far, a pennant by 87 %. Therefore diagonals are solved in
//! each pass. Their tension is kept from pass to pass, as that of warp and weft is, in their targets. On grids these hold for the
//! whole tick, and are put back after the passes. On nets they are computed in each substep (`shear.rs`).

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::Layout;
use crate::constraints::chain::Pass;
use crate::fabric::LinkFamily;
use crate::simd::lane::Pack;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Solves diagonals, and warp and weft, in each pass after the first solution of warp and weft.
    pub(super) fn solve_passes_of_cut_grid(&mut self, passes: u32) {
        let hold_for_tick = !self.fabric.is_net();
        if hold_for_tick {
            self.targets_of_tick.clone_from(&self.link_target);
        }
        for _ in 0..passes {
            self.solve_colours(Pass::Again, |family| family == LinkFamily::Diagonal);
            self.solve_warp_and_weft(Pass::Again);
        }
        if hold_for_tick {
            self.put_back_targets_of_diagonals();
        }
    }

    fn put_back_targets_of_diagonals(&mut self) {
        let chains = self.layout.chains(&self.fabric);
        let colours = chains.colours.iter().filter(|it| it.family == LinkFamily::Diagonal);
        for pair in colours.flat_map(|colour| &chains.pairs[colour.pairs.clone()]) {
            let targets = &self.targets_of_tick[pair.targets.clone()];
            self.link_target[pair.targets.clone()].copy_from_slice(targets);
        }
    }
}
