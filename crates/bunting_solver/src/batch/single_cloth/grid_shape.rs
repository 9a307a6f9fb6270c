//! The arrangement of a grid's arrays in memory, in row-major and in column-major order.

use super::lane_indices::MOST_LANES;
use crate::batch::layout::Order;
use crate::fabric::Grid;
use crate::simd::lane::Pack;

/// Number of elements before the first line of an array and after the last: a pack of diagonals may extend
/// beyond a line by up to all lanes but one.
pub(super) const MARGIN: usize = MOST_LANES;

/// Extent of a grid, and of the arrays with one number for each particle.
///
/// A line is a row in row-major order and a column in column-major order. Lines are filled up to whole packs
/// by particles that are pinned to the origin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GridShape {
    pub columns: usize,
    pub rows: usize,
    /// Number of elements from one line to the next in row-major order, a multiple of the lanes.
    pub row_stride: usize,
    /// Number of elements from one line to the next in column-major order.
    pub column_stride: usize,
    /// 2⁶⁴ over the number of columns, rounded up: a product with it takes a tenth of the time of a division.
    inverse_columns: u64,
}

impl GridShape {
    pub fn new<P: Pack>(grid: &Grid) -> Self {
        let [columns, rows] = [grid.columns, grid.rows].map(|count| count as usize);
        let [row_stride, column_stride] =
            [columns, rows].map(|count| count.next_multiple_of(P::WIDTH));
        let inverse_columns = (u64::MAX / columns as u64).saturating_add(1);
        Self { columns, rows, row_stride, column_stride, inverse_columns }
    }

    /// Row and column of a particle.
    #[inline]
    pub fn place(&self, particle: usize) -> (usize, usize) {
        let row = ((particle as u128 * u128::from(self.inverse_columns)) >> 64) as usize;
        (row, particle - row * self.columns)
    }

    /// Packs in a row.
    pub fn packs_in_row<P: Pack>(&self) -> usize {
        self.row_stride / P::WIDTH
    }

    /// Index in row-major order of the first particle of a pack of the state.
    pub fn start_of_pack<P: Pack>(pack: usize) -> u32 {
        (MARGIN + pack * P::WIDTH) as u32
    }

    /// Index of the particle at a place on a line. Places before or behind the line are other particles, or
    /// lie in the margin.
    pub fn index(&self, order: Order, line: usize, place: isize) -> u32 {
        let stride = match order {
            Order::RowMajor => self.row_stride,
            Order::ColumnMajor => self.column_stride,
        };
        ((MARGIN + line * stride) as isize + place) as u32
    }

    /// The particle at an index in row-major order, if there is one.
    pub fn particle(&self, index: u32) -> Option<usize> {
        self.particle_in(Order::RowMajor, index)
    }

    /// The particle at an index in an order, if there is one.
    pub fn particle_in(&self, order: Order, index: u32) -> Option<usize> {
        let index = (index as usize).checked_sub(MARGIN)?;
        let (row, column) = match order {
            Order::RowMajor => (index / self.row_stride, index % self.row_stride),
            Order::ColumnMajor => (index % self.column_stride, index / self.column_stride),
        };
        (row < self.rows && column < self.columns).then_some(row * self.columns + column)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::registers::Pack8;

    #[test]
    fn places_are_those_that_a_division_gives() {
        for columns in [2, 3, 7, 8, 25, 33, 64, 1000] {
            let shape = GridShape::new::<Pack8>(&Grid::new(columns, columns, 1.0, 1.0));
            let columns = columns as usize;
            for particle in 0..columns * columns {
                assert_eq!(shape.place(particle), (particle / columns, particle % columns));
            }
        }
    }
}
