//! The bias of a grid carries shear alone.
//!
//! Diagonals that want to be as long as at rest take a part of what pulls on warp and weft. But where a
//! sheet ends, so do they, and solved by themselves they let go of it there: over √(G/σ) h from each
//! edge, 16 cm of a standard sheet at two substeps, and all of a narrow strip. What a cloth stretches by
//! would depend on its width and on the substep. So warp and weft carry all of it, and the diagonals of a
//! cell are at rest when they are equally long, as those of a rectangle are, whatever its sides: half the
//! sum of their squares is the square of both.
//!
//! That length is found once a tick, since a cloth's own strain changes slowly. It is bounded by what the
//! loads may stretch: where a flag cracks like a whip, it is better held by its diagonals, too.

use core::ops::Range;

use crate::batch::lane_batch::LaneBatch;
use crate::batch::places::{Cloths, Constant, Places};
use crate::batch::single_cloth::{Facing, Weave};
use crate::fabric::{Cell, Grid};
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::V3;

/// Length of a grid's diagonals at rest, m.
fn length(grid: &Grid) -> f32 {
    libm::hypotf(grid.width / (grid.columns - 1) as f32, grid.height / (grid.rows - 1) as f32)
}

impl<P: Pack, C: Constant<P>> LaneBatch<P, C> {
    /// Finds how long the diagonals of each cell want to be, given warp and weft solved.
    pub fn square_cells(&mut self) {
        let Some(length) = self.fabric.grid().map(length) else { return };
        let stretch = self.parameters.bias_stretch;
        if C::SIDE > 1
            && let Some(weave) = self.woven()
        {
            weave.square_cells(length, &stretch);
            return;
        }
        P::run(Square {
            cells: &self.fabric.chains().cells,
            length,
            stretch: &stretch,
            target: &mut self.link_target,
            places: Cloths::new(&self.lane_weights, &mut self.position),
        });
    }

    /// Lets a cloth's diagonals be as long as at rest until its next tick.
    pub fn square_cells_as_at_rest(&mut self, lanes: Range<usize>) {
        let Some(length) = self.fabric.grid().map(length) else { return };
        let woven = self.weave.iter_mut().flat_map(|weave| &mut weave.target);
        for target in self.link_target.iter_mut().chain(woven) {
            target.lanes_mut()[lanes.clone()].fill(length);
        }
    }
}

impl<P: Pack> Weave<P> {
    fn square_cells(&mut self, length: f32, stretch: &P) {
        self.sheets.turn(Facing::Straight);
        P::run(Square {
            cells: &self.strands.cells,
            length,
            stretch,
            target: &mut self.target,
            places: self.sheets.threads(&self.present),
        });
    }
}

struct Square<'a, P: Pack, S: Places<P>> {
    cells: &'a [Cell],
    length: f32,
    /// In units of the length.
    stretch: &'a P,
    target: &'a mut [P],
    places: S,
}

impl<P: Pack, S: Places<P>> Kernel<P> for Square<'_, P, S> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let length = L::splat(token, self.length);
        let half = L::splat(token, 0.5 * self.length);
        let quarter_inverse = L::splat(token, 0.25 / self.length);
        let longest = length * L::load(token, self.stretch);
        let shortest = length + length - longest;
        for cell in self.cells {
            let [top_left, top_right, bottom_left, bottom_right] = cell.corners;
            let falling: V3<L> =
                self.places.position(token, bottom_right) - self.places.position(token, top_left);
            let rising: V3<L> =
                self.places.position(token, bottom_left) - self.places.position(token, top_right);
            // √((|d₁|² + |d₂|²)/2), but for the square of the strain.
            let squares = falling.dot(falling) + rising.dot(rising);
            let target = half.plus_product(squares, quarter_inverse);
            let target = shortest.max(longest.or_where_not(longest.lt(target), target));
            target.store(&mut self.target[cell.targets[0] as usize]);
            target.store(&mut self.target[cell.targets[1] as usize]);
        }
    }
}
