//! Shear of a grid: its diagonals carry shear alone.
//!
//! Diagonals with targets of their lengths at rest take a part of the tension of warp and weft. But at the edges
//! of a sheet they end, and release it: within √(G/σ) h of each edge, 16 cm of a standard sheet with two
//! substeps, and everywhere in a narrow strip. The stretch of a cloth would depend on its width and on the
//! substep. Therefore warp and weft carry all tension along them, and the diagonals of a cell are at rest when
//! they are equally long, as those of a rectangle are, whatever its sides: half the sum of their squares is the
//! square of each.
//!
//! This length is computed once a tick, since a cloth's own strain changes slowly. It is bounded by the strain
//! that the loads may cause: a flag that snaps like a whip is stretched further, and there the diagonals hold it
//! as well.

use core::ops::Range;

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Order, Particles, Positions};
use crate::fabric::{Cell, Grid};
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::V3;

/// Length of a grid's diagonals at rest, m.
fn length_at_rest(grid: &Grid) -> f32 {
    libm::hypotf(grid.width / (grid.columns - 1) as f32, grid.height / (grid.rows - 1) as f32)
}

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Computes the target of each diagonal from positions at which warp and weft are solved.
    pub fn find_diagonal_targets(&mut self) {
        let Some(length) = self.fabric.grid().map(length_at_rest) else { return };
        let (masses, linked) = (&self.masses.inverse, self.layout.linked());
        P::run(DiagonalTargets {
            cells: &self.layout.chains(&self.fabric).cells,
            length,
            stretch: &self.parameters.diagonal_stretch,
            target: &mut self.link_target,
            particles: self.positions.particles(Order::RowMajor, masses, linked),
        });
    }

    /// Sets the targets of a cloth's diagonals to their length at rest until its next tick.
    pub fn set_diagonals_at_rest(&mut self, lanes: Range<usize>) {
        let Some(length) = self.fabric.grid().map(length_at_rest) else { return };
        for target in &mut self.link_target {
            target.lanes_mut()[lanes.clone()].fill(length);
        }
    }
}

struct DiagonalTargets<'a, P: Pack, S: Particles<P>> {
    cells: &'a [Cell],
    /// At rest, m.
    length: f32,
    /// Greatest length, in units of that at rest.
    stretch: &'a P,
    target: &'a mut [P],
    particles: S,
}

impl<P: Pack, S: Particles<P>> Kernel<P> for DiagonalTargets<'_, P, S> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let Self { cells, target: targets, particles, .. } = self;
        let length = L::splat(token, self.length);
        let half = L::splat(token, 0.5 * self.length);
        let quarter_inverse = L::splat(token, 0.25 / self.length);
        let longest = length * L::load(token, self.stretch);
        let shortest = length + length - longest;
        for cell in cells {
            let [top_left, top_right, bottom_left, bottom_right] = cell.corners;
            let falling: V3<L> =
                particles.position(token, bottom_right) - particles.position(token, top_left);
            let rising: V3<L> =
                particles.position(token, bottom_left) - particles.position(token, top_right);
            // √((|d₁|² + |d₂|²)/2), linearised about the length at rest.
            let squares = falling.dot(falling) + rising.dot(rising);
            let target = half.plus_product(squares, quarter_inverse);
            let target = shortest.max(longest.or_where_not(longest.lt(target), target));
            target.store(&mut targets[cell.targets[0] as usize]);
            target.store(&mut targets[cell.targets[1] as usize]);
        }
    }
}
