//! Shear of a grid: its diagonals carry shear alone.
//!
//! Diagonals with their lengths at rest as targets would carry a part of the tension of warp and weft. But
//! they end at the edges of a sheet and release it there: within √(G/σ) h of each edge (16 cm for a standard
//! sheet with two substeps), and everywhere in a narrow strip. The stretch of a cloth would depend on its
//! width and on the substep. Therefore warp and weft carry all tension along them, and the diagonals of a
//! cell are at rest when they are equally long, as in a rectangle of any sides: the target's square is half
//! the sum of their squares.
//!
//! The target is computed once a tick, since a cloth's own strain changes slowly, but in each substep where passes keep the
//! tension of diagonals (`both_ways.rs`). It is bounded by the strain that the loads may cause: a flag that snaps like a whip is
//! stretched beyond this bound, and the diagonals then help to hold it.
//!
//! A cell that is folded along one diagonal is not sheared, though its other diagonal is short, and the length alone does
//! not tell which of the two it is. The push of a short diagonal is therefore bounded: its target is at most
//! [`GREATEST_PUSH`] times as long as the diagonal itself. Without this bound, cells that a jerk has folded against one another
//! hold themselves in place by a hundred times the weight of the cloth.

use core::ops::Range;

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Order, Particles, Positions};
use crate::fabric::Cell;
use crate::simd::constant::Constant;
use crate::simd::lane::{Kernel, Lane, Mask, Pack};
use crate::simd::vec3::V3;

/// Greatest target of a diagonal, in units of its length: the bound acts on cells sheared by more than 21°, and on folds.
/// With 1.3, creases that a jerk leaves in 65 × 65 begin to stay; with 1.2 and less, limp flags oscillate at their poles if
/// they have half of the substeps that they need.
const GREATEST_PUSH: f32 = 1.25;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Computes the target of each diagonal from positions at which warp and weft are satisfied.
    pub fn find_diagonal_targets(&mut self) {
        let (masses, linked) = (&self.masses.inverse, self.layout.linked());
        P::run(DiagonalTargets {
            cells: &self.layout.chains(&self.fabric).cells,
            lengths: &self.layout.chains(&self.fabric).diagonal_lengths,
            length: &self.numbers.diagonal_length,
            stretch: &self.parameters.diagonal_stretch,
            target: &mut self.link_target,
            particles: self.positions.particles(Order::RowMajor, masses, linked),
        });
    }

    /// Sets the targets of a cloth's diagonals to their length at rest until its next tick.
    pub fn set_diagonals_at_rest(&mut self, lanes: Range<usize>) {
        let lengths = &self.numbers.diagonal_length.lanes()[lanes.clone()];
        for target in &mut self.link_target {
            target.lanes_mut()[lanes.clone()].copy_from_slice(lengths);
        }
        let chains = self.layout.chains(&self.fabric);
        for (cell, lengths) in chains.cells.iter().zip(&chains.diagonal_lengths) {
            // The first diagonal is stored last, as it may be the only one.
            for at in [1, 0] {
                let target = &mut self.link_target[cell.targets[at] as usize];
                let length = lengths[at].pack();
                target.lanes_mut()[lanes.clone()].copy_from_slice(&length.lanes()[lanes.clone()]);
            }
        }
    }
}

struct DiagonalTargets<'a, P: Pack, S: Particles<P>> {
    cells: &'a [Cell],
    /// Of both diagonals of each cell at rest, m; empty where all are alike.
    lengths: &'a [[S::Constant; 2]],
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
        if !self.lengths.is_empty() {
            return self.of_unlike_cells::<L>(token);
        }
        let Self { cells, target: targets, particles, .. } = self;
        let length = L::load(token, self.length);
        let half = L::splat(token, 0.5) * length;
        let quarter_inverse = L::splat(token, 0.25) / length;
        let longest = length * L::load(token, self.stretch);
        let shortest = length + length - longest;
        for cell in cells {
            let [first, left, right, last] = cell.corners;
            let own: V3<L> = particles.position(token, last) - particles.position(token, first);
            let other: V3<L> = particles.position(token, right) - particles.position(token, left);
            let (own, other) = (own.dot(own), other.dot(other));
            // The target √((|d₁|² + |d₂|²)/2), linearised about the length at rest.
            let target = half.plus_product(own + other, quarter_inverse);
            let target = shortest.max(longest.or_where_not(longest.lt(target), target));
            // The first diagonal is stored last, as it may be the only one.
            let [of_first, of_second] = cell.targets;
            bounded(token, other, target).store(&mut targets[of_second as usize]);
            bounded(token, own, target).store(&mut targets[of_first as usize]);
        }
    }
}

impl<P: Pack, S: Particles<P>> DiagonalTargets<'_, P, S> {
    /// The targets of cells that are no rectangles and differ: diagonals are at rest when their ratio is that at rest.
    #[inline(always)]
    fn of_unlike_cells<L: Lane<Pack = P>>(self, token: L::Token) {
        let Self { cells, lengths, target: targets, particles, .. } = self;
        let (one, two, half) = (L::splat(token, 1.0), L::splat(token, 2.0), L::splat(token, 0.5));
        let longest = L::load(token, self.stretch);
        let shortest = one + one - longest;
        for (cell, [of_own, of_other]) in cells.iter().zip(lengths) {
            let (of_own, of_other): (L, L) = (of_own.load(token), of_other.load(token));
            let [first, left, right, last] = cell.corners;
            let own: V3<L> = particles.position(token, last) - particles.position(token, first);
            let other: V3<L> = particles.position(token, right) - particles.position(token, left);
            let (own, other) = (own.dot(own), other.dot(other));
            let at_rest = two * (of_own * of_own + of_other * of_other);
            // √(Σ|d|²/Σ|d₀|²), linearised about one.
            let stretch = half.plus_product(own + other, one / at_rest);
            let stretch = shortest.max(longest.or_where_not(longest.lt(stretch), stretch));
            // The first diagonal is stored last, as it may be the only one.
            let [of_first, of_second] = cell.targets;
            bounded(token, other, of_other * stretch).store(&mut targets[of_second as usize]);
            bounded(token, own, of_own * stretch).store(&mut targets[of_first as usize]);
        }
    }
}

/// The target of a diagonal with a bounded push, m, given the square of its length, m².
#[inline(always)]
fn bounded<L: Lane>(token: L::Token, squared: L, target: L) -> L {
    let bound = L::splat(token, GREATEST_PUSH * GREATEST_PUSH) * squared;
    let is_bounded = bound.lt(target * target);
    // Few cells are folded, and a square root takes long.
    if is_bounded.any() { bound.sqrt().or_where_not(is_bounded, target) } else { target }
}

#[cfg(test)]
mod tests {
    use glam::{Quat, Vec3};

    use super::GREATEST_PUSH;
    use crate::constraints::bench::cloth_at;
    use crate::fabric::{FabricBuilder, FabricMaterial, Grid};
    use crate::simd::lane::Pack;

    /// Targets of the falling and the rising diagonal of a cell of one metre, over their length at rest.
    fn targets(corners: [Vec3; 4]) -> [f32; 2] {
        let fabric = FabricBuilder::grid(Grid::new(2, 2, 1.0, 1.0)).build().expect("good");
        let mut batch = cloth_at(&fabric, FabricMaterial::SILK, &corners);
        batch.find_diagonal_targets();
        let indices = fabric.chains().cells[0].targets;
        indices.map(|at| batch.link_target[at as usize].lanes()[0] / 2.0_f32.sqrt())
    }

    /// Corners of a cell of one metre that is sheared within its plane by an angle.
    fn sheared(angle: f32) -> [Vec3; 4] {
        let down = Vec3::new(libm::sinf(angle), -libm::cosf(angle), 0.0);
        [Vec3::ZERO, Vec3::X, down, Vec3::X + down]
    }

    #[test]
    fn diagonals_of_a_sheared_cell_have_their_length_at_rest_as_target() {
        for shear in [-0.3_f32, -0.1, 0.1, 0.3] {
            for target in targets(sheared(shear)) {
                assert!((target - 1.0).abs() < 0.01, "shear of {shear}: {target}");
            }
        }
    }

    #[test]
    fn the_short_diagonal_of_a_cell_sheared_far_pushes_by_a_bounded_force() {
        for shear in [0.5_f32, 1.0, 1.5] {
            let short = libm::sqrtf(1.0 - libm::sinf(shear));
            let [falling, rising] = targets(sheared(shear));
            assert!((rising - GREATEST_PUSH * short).abs() < 0.01, "shear of {shear}: {rising}");
            assert!((falling - 1.0).abs() < 0.01, "shear of {shear}: {falling}");
        }
    }

    #[test]
    fn a_diagonal_across_a_fold_pushes_by_a_bounded_force() {
        let rising = Vec3::new(1.0, 1.0, 0.0).normalize();
        let (left, right) = (Vec3::NEG_Y, Vec3::X);
        for angle in [0.2_f32, 1.0, 2.0, 3.0] {
            let folded = left + Quat::from_axis_angle(rising, angle) * Vec3::X;
            let [falling, rising] = targets([Vec3::ZERO, right, left, folded]);
            let most = (GREATEST_PUSH * folded.length() / 2.0_f32.sqrt()).min(1.0);
            assert!((falling - most).abs() < 0.01, "angle of {angle}: {falling} instead of {most}");
            assert!((rising - 1.0).abs() < 0.01, "angle of {angle}: {rising}");
        }
    }
}
