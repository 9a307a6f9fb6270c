//! The rectangular grid: flags, sails, curtains.

use glam::{Vec2, Vec3};

use super::error::FabricError;

/// A rectangular grid of particles.
///
/// Particle `row * columns + column` rests at `(column · width/(columns−1), −row · height/(rows−1),
/// 0)`: the origin is the top left corner, the front faces +z, u grows to the right and v down.
///
/// ```
/// use bunting_solver::Grid;
///
/// // Two by three metres, with a particle every 25 cm.
/// let grid = Grid::new(9, 13, 2.0, 3.0);
/// assert_eq!(grid.index(8, 12), 9 * 13 - 1);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Particles in a row, at least 2.
    pub columns: u32,
    /// Particles in a column, at least 2.
    pub rows: u32,
    /// Extent along a row, m.
    pub width: f32,
    /// Extent along a column, m.
    pub height: f32,
}

impl Grid {
    /// A grid of `columns` × `rows` particles over `width` × `height` metres.
    #[must_use]
    pub const fn new(columns: u32, rows: u32, width: f32, height: f32) -> Self {
        Self { columns, rows, width, height }
    }

    /// Length of the diagonals of cells at rest, m.
    pub(crate) fn diagonal(&self) -> f32 {
        libm::hypotf(self.width / (self.columns - 1) as f32, self.height / (self.rows - 1) as f32)
    }

    /// Index of the particle in a column and row.
    #[must_use]
    pub const fn index(&self, column: u32, row: u32) -> u32 {
        row * self.columns + column
    }

    /// The grid of every second column and row; none unless both counts are odd and at least 3.
    #[must_use]
    pub fn halved(&self) -> Option<Self> {
        let halve = |count: u32| (count >= 3 && count % 2 == 1).then_some(count / 2 + 1);
        Some(Self { columns: halve(self.columns)?, rows: halve(self.rows)?, ..*self })
    }

    /// Checks that there are at least two columns and rows, and that both lengths are positive.
    pub(super) fn validate(&self) -> Result<(), FabricError> {
        let positive = |length: f32| length > 0.0 && length.is_finite();
        let cells = u64::from(self.columns) * u64::from(self.rows);
        if self.columns < 2
            || self.rows < 2
            || cells > u64::from(u32::MAX)
            || !positive(self.width)
            || !positive(self.height)
        {
            let Self { columns, rows, width, height } = *self;
            return Err(FabricError::Grid { columns, rows, width, height });
        }
        Ok(())
    }

    /// Area of each particle, m²: a quarter of each cell that it borders. Thirds of triangles would alternate 1 : 2
    /// along the border, and the two lines of a strip would swing with different periods.
    pub(super) fn particle_areas(&self) -> Vec<f32> {
        let [dx, dy] = self.spacing();
        let neighbours = |at: u32, count: u32| if at == 0 || at + 1 == count { 1.0 } else { 2.0 };
        let of_row = |row: u32| {
            let across = neighbours(row, self.rows);
            (0..self.columns).map(move |column| neighbours(column, self.columns) * across)
        };
        (0..self.rows).flat_map(of_row).map(|cells| 0.25 * dx * dy * cells).collect()
    }

    /// Positions at rest, m, one per particle.
    pub(crate) fn positions(&self) -> Vec<Vec3> {
        self.nodes(|u, v| Vec3::new(u * self.width, -v * self.height, 0.0))
    }

    /// Texture coordinates, one per particle: from 0 to 1 along both sides.
    #[must_use]
    pub fn uvs(&self) -> Vec<Vec2> {
        self.nodes(Vec2::new)
    }

    /// One value for each particle, from its fractions (0 to 1) along a row and along a column.
    fn nodes<T>(&self, node: impl Fn(f32, f32) -> T) -> Vec<T> {
        let fraction = |index: u32, count: u32| index as f32 / (count.max(2) - 1) as f32;
        (0..self.rows)
            .flat_map(|row| (0..self.columns).map(move |column| (column, row)))
            .map(|(column, row)| node(fraction(column, self.columns), fraction(row, self.rows)))
            .collect()
    }

    /// Distances between neighbours along a row and along a column, m.
    pub(crate) fn spacing(&self) -> [f32; 2] {
        [self.width / (self.columns - 1) as f32, self.height / (self.rows - 1) as f32]
    }

    /// The particles at the corners of each cell (top left, top right, bottom left, bottom right), and
    /// whether the cell is an even one of a chessboard.
    pub(crate) fn cells(&self) -> impl Iterator<Item = ([u32; 4], bool)> + '_ {
        (0..self.rows - 1).flat_map(move |row| {
            (0..self.columns - 1).map(move |column| {
                let corner = |right, down| self.index(column + right, row + down);
                let corners = [corner(0, 0), corner(1, 0), corner(0, 1), corner(1, 1)];
                (corners, (column + row) % 2 == 0)
            })
        })
    }

    /// Two triangles for each cell, with a diagonal that alternates from cell to cell so that no direction is
    /// preferred. `flipped` splits each cell along its other diagonal.
    pub(crate) fn triangles(&self, flipped: bool) -> Vec<[u32; 3]> {
        self.cells()
            .flat_map(|([top_left, top_right, bottom_left, bottom_right], even)| {
                if even != flipped {
                    [[top_left, bottom_left, bottom_right], [top_left, bottom_right, top_right]]
                } else {
                    [[top_left, bottom_left, top_right], [top_right, bottom_left, bottom_right]]
                }
            })
            .collect()
    }
}
