//! Sums over the triangles at each particle, of cloths side by side.
//!
//! Where the triangles are the cells of a grid, a row of cells is passed from left to right: what it gives
//! to the right is carried in registers, and what it gives downwards in a line that stays in the nearest
//! cache, so that each particle's sum is written once and never read. It is taken in the order of the
//! patches all the same.

use crate::fabric::{Fabric, Patch};
use crate::simd::lane::Lane;
use crate::simd::vec3::{Pack3, V3};

/// What triangles give to their corners.
pub(crate) trait Giver<L: Lane> {
    /// What the triangles (a, b, c) and (a, c, d) of a patch give to each of their corners.
    fn give(&self, token: L::Token, patch: &Patch) -> [V3<L>; 2];

    /// What becomes of the sum of a particle.
    fn finish(&self, token: L::Token, sum: V3<L>) -> V3<L>;
}

/// Sums what all triangles give to their corners. `below` is room for a row of a grid.
#[inline(always)]
pub(crate) fn sum_corners<L: Lane, G: Giver<L>>(
    token: L::Token,
    fabric: &Fabric,
    giver: &G,
    below: &mut [Pack3<L::Pack>],
    sums: &mut [Pack3<L::Pack>],
) {
    match fabric.patch_grid_columns() {
        Some(columns) => {
            let below = &mut below[..columns];
            for sum in below.iter_mut() {
                V3::<L>::splat(token, 0.0).store(sum);
            }
            let mut rows = fabric.patches().chunks_exact(columns - 1);
            for sums in sums.chunks_exact_mut(columns) {
                match rows.next() {
                    Some(cells) => sum_row(token, cells, giver, below, sums),
                    None => {
                        for (sum, above) in sums.iter_mut().zip(&*below) {
                            giver.finish(token, V3::load(token, above)).store(sum);
                        }
                    }
                }
            }
        }
        None => sum_patches(token, fabric.patches(), giver, sums),
    }
}

/// The particles at the upper border of a row of cells. `below` holds what those above give to them, and
/// then what these give to the next.
#[inline(always)]
fn sum_row<L: Lane, G: Giver<L>>(
    token: L::Token,
    cells: &[Patch],
    giver: &G,
    below: &mut [Pack3<L::Pack>],
    sums: &mut [Pack3<L::Pack>],
) {
    let nothing = V3::<L>::splat(token, 0.0);
    // What the cell on the left gives to the right.
    let (mut top, mut bottom) = (nothing, nothing);
    let ([sums @ .., last_sum], [below @ .., last_below]) = (sums, below) else { return };
    for ((cell, sum), below) in cells.iter().zip(sums).zip(below) {
        let [first, second] = giver.give(token, cell);
        let both = first + second;
        let above = V3::load(token, below) + top;
        // Cut from the top left, which is a, to the bottom right, or from the top right.
        if cell.corners[1] > cell.corners[3] {
            giver.finish(token, above + both).store(sum);
            (bottom + first).store(below);
            (top, bottom) = (second, both);
        } else {
            giver.finish(token, above + first).store(sum);
            (bottom + both).store(below);
            (top, bottom) = (both, second);
        }
    }
    giver.finish(token, V3::load(token, last_below) + top).store(last_sum);
    bottom.store(last_below);
}

/// Patch by patch, wherever they lie.
#[inline(always)]
fn sum_patches<L: Lane, G: Giver<L>>(
    token: L::Token,
    patches: &[Patch],
    giver: &G,
    sums: &mut [Pack3<L::Pack>],
) {
    for sum in sums.iter_mut() {
        V3::<L>::splat(token, 0.0).store(sum);
    }
    for patch in patches {
        let [first, second] = giver.give(token, patch);
        let both = first + second;
        let [a, b, c, d] = patch.corners;
        both.add_to(token, &mut sums[a as usize]);
        first.add_to(token, &mut sums[b as usize]);
        both.add_to(token, &mut sums[c as usize]);
        second.add_to(token, &mut sums[d as usize]);
    }
    for sum in sums {
        giver.finish(token, V3::load(token, sum)).store(sum);
    }
}
