//! Shear of a grid: its diagonals carry shear alone.
//!
//! Diagonals with their lengths at rest as targets would carry a part of the tension of warp and weft. But
//! they end at the edges of a sheet and release it there: within √(G/σ) h of each edge (16 cm for a standard
//! sheet with two substeps), and everywhere in a narrow strip. The stretch of a cloth would depend on its
//! width and on the substep. Therefore warp and weft carry all tension along them, and the diagonals of a
//! cell are at rest when they are equally long, as in a rectangle of any sides: the target's square is half
//! the sum of their squares.
//!
//! The target is computed once a tick, since a cloth's own strain changes slowly. It is bounded by the strain
//! that the loads may cause: a flag that snaps like a whip is stretched beyond this bound, and the diagonals
//! then help to hold it.

use core::ops::Range;

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Order, Particles, Positions};
use crate::fabric::Cell;
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::V3;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Computes the target of each diagonal from positions at which warp and weft are satisfied.
    pub fn find_diagonal_targets(&mut self) {
        if self.fabric.grid().is_none() {
            return;
        }
        let (masses, linked) = (&self.masses.inverse, self.layout.linked());
        P::run(DiagonalTargets {
            cells: &self.layout.chains(&self.fabric).cells,
            length: &self.numbers.diagonal_length,
            stretch: &self.parameters.diagonal_stretch,
            target: &mut self.link_target,
            particles: self.positions.particles(Order::RowMajor, masses, linked),
        });
    }

    /// Sets the targets of a cloth's diagonals to their length at rest until its next tick.
    pub fn set_diagonals_at_rest(&mut self, lanes: Range<usize>) {
        if self.fabric.grid().is_none() {
            return;
        }
        let lengths = &self.numbers.diagonal_length.lanes()[lanes.clone()];
        for target in &mut self.link_target {
            target.lanes_mut()[lanes.clone()].copy_from_slice(lengths);
        }
    }
}

struct DiagonalTargets<'a, P: Pack, S: Particles<P>> {
    cells: &'a [Cell],
    /// At rest, m.
    length: &'a P,
    /// Greatest length, in units of that at rest.
    stretch: &'a P,
    target: &'a mut [P],
    particles: S,
}

impl<P: Pack, S: Particles<P>> Kernel<P> for DiagonalTargets<'_, P, S> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let Self { cells, target: targets, particles, .. } = self;
        let length = L::load(token, self.length);
        let half = L::splat(token, 0.5) * length;
        let quarter_inverse = L::splat(token, 0.25) / length;
        let longest = length * L::load(token, self.stretch);
        let shortest = length + length - longest;
        for cell in cells {
            let [top_left, top_right, bottom_left, bottom_right] = cell.corners;
            let falling: V3<L> =
                particles.position(token, bottom_right) - particles.position(token, top_left);
            let rising: V3<L> =
                particles.position(token, bottom_left) - particles.position(token, top_right);
            // The target √((|d₁|² + |d₂|²)/2), linearised about the length at rest.
            let squares = falling.dot(falling) + rising.dot(rising);
            let target = half.plus_product(squares, quarter_inverse);
            let target = shortest.max(longest.or_where_not(longest.lt(target), target));
            target.store(&mut targets[cell.targets[0] as usize]);
            target.store(&mut targets[cell.targets[1] as usize]);
        }
    }
}
