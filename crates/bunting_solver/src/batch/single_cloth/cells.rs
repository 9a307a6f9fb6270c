//! Sums over the triangles of a grid, with its cells in the lanes.
//!
//! A particle's sum is taken in the order of the fabric's patches: row by row, and from left to right.

use super::sheets::{MARGIN, Plane};
use crate::batch::places::Constant;
use crate::fabric::Fabric;
use crate::simd::lane::{Lane, Pack};
use crate::simd::vec3::V3;

/// The cells of a grid.
#[derive(Clone, Debug)]
pub(crate) struct Cells<P: Pack> {
    /// Numbers from one row of particles to the next.
    stride: usize,
    /// A third of each triangle's area, m²: of the first and the second triangles of packs of cells, row
    /// by row; zero where there is no cell.
    shares: Vec<[P; 2]>,
    /// One in lanes whose cells are cut from the top left to the bottom right: in rows whose first is,
    /// and in the others.
    falling: [P; 2],
    /// What the cells of a row give to their corners: top left and top right; bottom left and bottom
    /// right, of this row and of the one above.
    top: [Plane; 2],
    bottom: [[Plane; 2]; 2],
}

/// What triangles give to their corners.
pub(crate) trait Giver<L: Lane> {
    /// What the triangles (a, b, c) and (a, c, d) of a pack of cells give; nothing where they have no
    /// share of the area.
    fn give(&self, token: L::Token, corners: Corners<L>, shares: [L; 2]) -> [V3<L>; 2];

    /// What becomes of the sums of the particles of a pack.
    fn put(&mut self, token: L::Token, pack: usize, sum: V3<L>);
}

/// The corners of a pack of cells.
#[derive(Clone, Copy)]
pub(crate) struct Corners<L: Lane> {
    top_left: usize,
    stride: usize,
    falling: L::Mask,
}

impl<L: Lane> Corners<L> {
    /// Of what there is at each particle, that at the corners a, b, c and d.
    #[inline(always)]
    pub fn of(self, token: L::Token, plane: &Plane) -> [V3<L>; 4] {
        let top_left: V3<L> = plane.load(token, self.top_left);
        let top_right: V3<L> = plane.load(token, self.top_left + 1);
        let bottom_left: V3<L> = plane.load(token, self.top_left + self.stride);
        let bottom_right: V3<L> = plane.load(token, self.top_left + self.stride + 1);
        [
            top_left.or_where_not(self.falling, top_right),
            bottom_left.or_where_not(self.falling, top_left),
            bottom_right.or_where_not(self.falling, bottom_left),
            top_right.or_where_not(self.falling, bottom_right),
        ]
    }
}

impl<P: Pack> Cells<P> {
    /// None unless the fabric's patches are its cells, row by row.
    pub fn of(fabric: &Fabric, stride: usize) -> Option<Self> {
        let across = fabric.patch_grid_columns()? - 1;
        let rows = fabric.patches().chunks(across);
        let shares = rows.flat_map(|row| {
            (0..stride).step_by(P::WIDTH).map(|first| {
                [0, 1].map(|half| {
                    P::of(|lane| {
                        row.get(first + lane).map_or(0.0, |patch| patch.corner_areas[half])
                    })
                })
            })
        });
        let plane = || Plane::new(1, stride);
        Some(Self {
            stride,
            shares: shares.collect(),
            falling: [1, 0].map(|even| P::of(|lane| ((lane + even) % 2) as f32)),
            top: [plane(), plane()],
            bottom: [[plane(), plane()], [plane(), plane()]],
        })
    }

    /// Sums what all triangles give to their corners.
    #[inline(always)]
    pub fn sum<L: Lane<Pack = P>, G: Giver<L>>(&mut self, token: L::Token, giver: &mut G) {
        let blocks = self.stride / P::WIDTH;
        let rows = self.shares.len() / blocks;
        let nothing = V3::<L>::splat(token, 0.0);
        let half = L::splat(token, 0.5);
        let [above, below] = &mut self.bottom;
        for block in 0..blocks {
            above[0].store(MARGIN + block * P::WIDTH, nothing);
            above[1].store(MARGIN + block * P::WIDTH, nothing);
        }
        // Row by row of particles, with the cells below each; there are none below the last.
        for row in 0..=rows {
            let shares = self.shares.get(row * blocks..(row + 1) * blocks);
            let falling = half.lt(L::load(token, &self.falling[row % 2]));
            for block in 0..blocks {
                let at = MARGIN + block * P::WIDTH;
                let Some(shares) = shares else {
                    self.top[0].store(at, nothing);
                    self.top[1].store(at, nothing);
                    continue;
                };
                let top_left = row * self.stride + at;
                let corners = Corners { top_left, stride: self.stride, falling };
                let [first, second] = &shares[block];
                let shares = [L::load(token, first), L::load(token, second)];
                let [first, second] = giver.give(token, corners, shares);
                let both = first + second;
                self.top[0].store(at, both.or_where_not(falling, first));
                self.top[1].store(at, second.or_where_not(falling, both));
                below[0].store(at, first.or_where_not(falling, both));
                below[1].store(at, both.or_where_not(falling, second));
            }
            for block in 0..blocks {
                let at = MARGIN + block * P::WIDTH;
                let sum = nothing
                    + above[1].load(token, at - 1)
                    + above[0].load(token, at)
                    + self.top[1].load(token, at - 1)
                    + self.top[0].load(token, at);
                giver.put(token, row * blocks + block, sum);
            }
            core::mem::swap(above, below);
        }
    }
}
