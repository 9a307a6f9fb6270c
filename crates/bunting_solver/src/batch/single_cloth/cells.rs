//! Sums over the triangles at each particle of a single cloth, in packs of consecutive cells.
//!
//! The terms of a particle's sum are added in the order of the fabric's patches: row by row, and from left to
//! right.

use super::grid_shape::{GridShape, MARGIN};
use super::vector_grid::VectorGrid;
use crate::fabric::Fabric;
use crate::geometry::corners::{Contribution, CornerSums, Corners};
use crate::simd::constant::Constant;
use crate::simd::lane::{Lane, Pack};
use crate::simd::vec3::{Pack3, V3};

/// The cells of a grid.
#[derive(Clone, Debug)]
pub(crate) struct Cells<P: Pack> {
    /// Number of elements from one row of particles to the next.
    stride: usize,
    /// A quarter of the area, m², of the first and of the second triangle of each cell, in packs of cells, row
    /// by row; zero in lanes without a cell.
    corner_areas: Vec<[P; 2]>,
    /// One in lanes whose cells have their diagonal from the top left to the bottom right, zero in others:
    /// for even rows of cells, and for odd ones.
    falling: [P; 2],
    /// Contributions of the cells to each of their corners: of the row above, and of this row.
    contributions: [VectorGrid; 2],
}

impl<P: Pack> Cells<P> {
    /// The cells of a fabric; none unless its patches are the cells of a grid, row by row.
    pub fn new(fabric: &Fabric, shape: GridShape) -> Option<Self> {
        let columns = fabric.patch_grid_columns()? - 1;
        let stride = shape.row_stride;
        let rows = fabric.patches().chunks(columns);
        let corner_areas = rows.flat_map(|row| {
            (0..stride).step_by(P::WIDTH).map(|first| {
                [0, 1].map(|half| {
                    P::of(|lane| {
                        row.get(first + lane).map_or(0.0, |patch| patch.corner_areas[half])
                    })
                })
            })
        });
        let row = || VectorGrid::new(1, stride);
        Some(Self {
            stride,
            corner_areas: corner_areas.collect(),
            falling: [1, 0].map(|even| P::of(|lane| ((lane + even) % 2) as f32)),
            contributions: [row(), row()],
        })
    }
}

/// The corners of a pack of cells.
#[derive(Clone, Copy)]
struct PackCorners<L: Lane> {
    top_left: usize,
    stride: usize,
    falling: L::Mask,
    areas: [L; 2],
}

impl<L: Lane> Corners<L> for PackCorners<L> {
    type Field = VectorGrid;

    #[inline(always)]
    fn load(&self, token: L::Token, field: &VectorGrid) -> [V3<L>; 4] {
        let top_left: V3<L> = field.load(token, self.top_left);
        let top_right: V3<L> = field.load(token, self.top_left + 1);
        let bottom_left: V3<L> = field.load(token, self.top_left + self.stride);
        let bottom_right: V3<L> = field.load(token, self.top_left + self.stride + 1);
        [
            top_left.or_where_not(self.falling, top_right),
            bottom_left.or_where_not(self.falling, top_left),
            bottom_right.or_where_not(self.falling, bottom_left),
            top_right.or_where_not(self.falling, bottom_right),
        ]
    }

    #[inline(always)]
    fn areas(&self, _: L::Token) -> [L; 2] {
        self.areas
    }

    #[inline(always)]
    fn where_present(&self, token: L::Token, vector: V3<L>) -> V3<L> {
        let [first, _] = self.areas;
        vector.or_where_not(L::splat(token, 0.0).lt(first), V3::splat(token, 0.0))
    }
}

impl<P: Pack> CornerSums<P> for &mut Cells<P> {
    type Field = VectorGrid;

    #[inline(always)]
    fn sum<L: Lane<Pack = P>, T: Contribution<L, VectorGrid>>(
        self,
        token: L::Token,
        contribution: &T,
        sums: &mut [Pack3<P>],
    ) {
        let Cells { stride, corner_areas, falling, contributions } = self;
        let blocks = *stride / P::WIDTH;
        let rows = corner_areas.len() / blocks;
        let zero = V3::<L>::splat(token, 0.0);
        let half = L::splat(token, 0.5);
        let [above, below] = contributions;
        for block in 0..blocks {
            above.store(MARGIN + block * P::WIDTH, zero);
        }
        // Rows of particles are summed one by one, each with the cells below it; the last row has none below.
        for row in 0..=rows {
            let areas = corner_areas.get(row * blocks..(row + 1) * blocks);
            let falling = half.lt(L::load(token, &falling[row % 2]));
            for block in 0..blocks {
                let at = MARGIN + block * P::WIDTH;
                let Some(areas) = areas else {
                    below.store(at, zero);
                    continue;
                };
                let [first, second] = &areas[block];
                let corners = PackCorners {
                    top_left: row * *stride + at,
                    stride: *stride,
                    falling,
                    areas: [L::load(token, first), L::load(token, second)],
                };
                let [first, second] = contribution.of(token, &corners);
                below.store(at, first + second);
            }
            for block in 0..blocks {
                let at = MARGIN + block * P::WIDTH;
                let sum = zero
                    + above.load(token, at - 1)
                    + above.load(token, at)
                    + below.load(token, at - 1)
                    + below.load(token, at);
                contribution.finish(token, sum).store(&mut sums[row * blocks + block]);
            }
            core::mem::swap(above, below);
        }
    }
}
