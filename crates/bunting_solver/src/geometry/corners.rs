//! Sums over the triangles at each particle, for normals and air.
//!
//! Triangles are summed in pairs, the patches of the fabric. If patches are the cells of a grid, a row of
//! cells is passed from left to right: a cell contributes the same to each of its corners; contributions to the
//! right are carried in a register, and contributions downwards in one row of packs that stays in the nearest
//! cache, so that each particle's sum is written once and never read. The order of the terms in a sum is still
//! that of the patches.

use crate::fabric::Patch;
use crate::simd::constant::Constant;
use crate::simd::lane::{Lane, Pack};
use crate::simd::vec3::{Pack3, V3};

/// The corners a, b, c and d of two triangles (a, b, c) and (a, c, d), or of such pairs in lanes.
pub(crate) trait Corners<L: Lane> {
    /// Vectors of all particles.
    type Field: ?Sized;

    /// The vectors at the corners.
    fn load(&self, token: L::Token, field: &Self::Field) -> [V3<L>; 4];

    /// The part of each triangle's area that belongs to a corner, m²; zero in lanes without triangles.
    fn areas(&self, token: L::Token) -> [L; 2];

    /// `vector` in lanes that have triangles, zero in others.
    fn where_present(&self, token: L::Token, vector: V3<L>) -> V3<L>;
}

/// Contribution of triangles to the sum at each of their corners.
pub(crate) trait Contribution<L: Lane, F: ?Sized> {
    /// The contributions of the two triangles with these corners.
    fn of<C: Corners<L, Field = F>>(&self, token: L::Token, corners: &C) -> [V3<L>; 2];

    /// Stored result, from the sum at a particle.
    fn finish(&self, token: L::Token, sum: V3<L>) -> V3<L>;
}

/// Sums over the triangles at each particle, for one layout.
pub(crate) trait CornerSums<P: Pack> {
    /// Vectors of all particles.
    type Field: ?Sized;

    /// Sums the contributions of all triangles at each of their corners.
    fn sum<L: Lane<Pack = P>, T: Contribution<L, Self::Field>>(
        self,
        token: L::Token,
        contribution: &T,
        sums: &mut [Pack3<P>],
    );
}

impl<L: Lane, C: Constant<L::Pack>> Corners<L> for &Patch<C> {
    type Field = [Pack3<L::Pack>];

    #[inline(always)]
    fn load(&self, token: L::Token, field: &Self::Field) -> [V3<L>; 4] {
        Patch::load(self, token, field)
    }

    #[inline(always)]
    fn areas(&self, token: L::Token) -> [L; 2] {
        let [first, second] = &self.corner_areas;
        [first.load(token), second.load(token)]
    }

    #[inline(always)]
    fn where_present(&self, _: L::Token, vector: V3<L>) -> V3<L> {
        vector
    }
}

/// Sums over the patches of cloths side by side.
pub(crate) struct PatchSums<'a, P: Pack, C> {
    pub patches: &'a [Patch<C>],
    /// Number of particles in a row, where the patches are the cells of a grid, row by row; else none.
    pub grid_columns: Option<usize>,
    /// Scratch row of the contributions of a row of cells to the particles below it.
    pub below: &'a mut [Pack3<P>],
}

impl<P: Pack, C: Constant<P>> CornerSums<P> for PatchSums<'_, P, C> {
    type Field = [Pack3<P>];

    #[inline(always)]
    fn sum<L: Lane<Pack = P>, T: Contribution<L, Self::Field>>(
        self,
        token: L::Token,
        contribution: &T,
        sums: &mut [Pack3<P>],
    ) {
        let Self { patches, grid_columns, below } = self;
        let Some(columns) = grid_columns else {
            sum_patches(token, patches, contribution, sums);
            return;
        };
        let below = &mut below[..columns];
        for sum in below.iter_mut() {
            V3::<L>::splat(token, 0.0).store(sum);
        }
        let mut rows = patches.chunks_exact(columns - 1);
        for sums in sums.chunks_exact_mut(columns) {
            match rows.next() {
                Some(cells) => sum_row(token, cells, contribution, below, sums),
                None => {
                    for (sum, above) in sums.iter_mut().zip(&*below) {
                        contribution.finish(token, V3::load(token, above)).store(sum);
                    }
                }
            }
        }
    }
}

/// Finishes the sums of the particles along the upper border of a row of cells. `below` holds the
/// contributions of the row above to these particles, and afterwards those of this row to the next.
#[inline(always)]
fn sum_row<L: Lane, C: Constant<L::Pack>, T: Contribution<L, [Pack3<L::Pack>]>>(
    token: L::Token,
    cells: &[Patch<C>],
    contribution: &T,
    below: &mut [Pack3<L::Pack>],
    sums: &mut [Pack3<L::Pack>],
) {
    let zero = V3::<L>::splat(token, 0.0);
    // Contribution of the cell on the left.
    let mut left = zero;
    let ([sums @ .., last_sum], [below @ .., last_below]) = (sums, below) else { return };
    for ((cell, sum), below) in cells.iter().zip(sums).zip(below) {
        let [first, second] = contribution.of(token, &cell);
        let both = first + second;
        contribution.finish(token, V3::load(token, below) + left + both).store(sum);
        (left + both).store(below);
        left = both;
    }
    contribution.finish(token, V3::load(token, last_below) + left).store(last_sum);
    left.store(last_below);
}

/// Sums the contributions of patches in any arrangement.
#[inline(always)]
fn sum_patches<L: Lane, C: Constant<L::Pack>, T: Contribution<L, [Pack3<L::Pack>]>>(
    token: L::Token,
    patches: &[Patch<C>],
    contribution: &T,
    sums: &mut [Pack3<L::Pack>],
) {
    for sum in sums.iter_mut() {
        V3::<L>::splat(token, 0.0).store(sum);
    }
    for patch in patches {
        let [first, second] = contribution.of(token, &patch);
        let both = first + second;
        let [a, b, c, d] = patch.corners;
        both.add_to(token, &mut sums[a as usize]);
        first.add_to(token, &mut sums[b as usize]);
        both.add_to(token, &mut sums[c as usize]);
        second.add_to(token, &mut sums[d as usize]);
    }
    for sum in sums {
        contribution.finish(token, V3::load(token, sum)).store(sum);
    }
}
