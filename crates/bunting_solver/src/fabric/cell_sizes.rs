//! Sizes of the cells of a grid that differ: its lines are curved and unevenly far apart, or only a part of a cell is cloth.

use glam::Vec3;

use super::grid::Grid;

/// The sizes of a grid's cells, and what follows from them at its particles.
#[derive(Clone, Debug)]
pub(super) struct CellSizes {
    /// Area of each cell, m².
    pub areas: Vec<f32>,
    /// Stiffness of each cell against twist, in units of the material's bending stiffness, 1/m².
    pub twists: Vec<f32>,
    /// Of each particle the mean distance of its neighbours in its row, and in its column, m.
    pub spacings: Vec<[f32; 2]>,
    /// Of each particle the width of cloth that its row stands for there, and its column, m.
    pub widths: Vec<[f32; 2]>,
}

impl CellSizes {
    /// The sizes at positions at rest, m. The first and the last row of a closed grid are at one place, and each stands
    /// for the cells on one side.
    pub fn of(grid: &Grid, positions: &[Vec3], is_closed: bool) -> Self {
        let area = |(corners, _): ([u32; 4], bool)| {
            let [a, b, c, d] = corners.map(|at| positions[at as usize]);
            0.5 * (d - a).cross(c - b).length()
        };
        let (mut spacings, mut widths) = (Vec::new(), Vec::new());
        for node in 0..grid.columns * grid.rows {
            let (column, row) = (node % grid.columns, node / grid.columns);
            let distance =
                |other: u32| positions[node as usize].distance(positions[other as usize]);
            let [before, after, above, below] = grid.neighbours((column, row), is_closed);
            let [along, across] = [[before, after], [above, below]].map(|pair| {
                let sum: f32 = pair.map(distance).iter().sum();
                let is_end = pair.contains(&node);
                (if is_end { sum } else { 0.5 * sum }, 0.5 * sum)
            });
            let at_seam = is_closed && (row == 0 || row + 1 == grid.rows);
            spacings.push([along.0, across.0]);
            widths.push([if at_seam { 0.5 * across.1 } else { across.1 }, along.1]);
        }
        let areas: Vec<f32> = grid.cells().map(area).collect();
        Self { twists: areas.iter().map(|area| 2.0 / area).collect(), areas, spacings, widths }
    }

    /// The sizes where only a part of each cell is cloth, or nothing.
    pub fn covered(grid: &Grid, parts: &[f32]) -> Self {
        let [dx, dy] = grid.spacing();
        let (columns, rows) = (grid.columns as i32, grid.rows as i32);
        let part = |column: i32, row: i32| {
            let is_cell = (0..columns - 1).contains(&column) && (0..rows - 1).contains(&row);
            if is_cell { parts[(row * (columns - 1) + column) as usize] } else { 0.0 }
        };
        let mut widths = Vec::new();
        for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |at| (row, at))) {
            // A row at a node is as wide as the narrower of its two links there.
            let right = |column: i32| 0.5 * (part(column, row - 1) + part(column, row));
            let down = |row: i32| 0.5 * (part(column - 1, row) + part(column, row));
            widths.push([
                dy * right(column - 1).min(right(column)),
                dx * down(row - 1).min(down(row)),
            ]);
        }
        Self {
            areas: parts.iter().map(|part| part * dx * dy).collect(),
            twists: parts.iter().map(|part| 2.0 * part / (dx * dy)).collect(),
            spacings: vec![[dx, dy]; widths.len()],
            widths,
        }
    }

    /// The part of each particle's cells that is cloth, given the particles' areas, m².
    pub fn parts_of(&self, areas: &[f32], grid: &Grid) -> Vec<f32> {
        areas.iter().zip(grid.particle_areas()).map(|(area, whole)| area / whole).collect()
    }

    /// Area of each particle, m²: a quarter of each cell that it borders.
    pub fn particle_areas(&self, grid: &Grid) -> Vec<f32> {
        let mut areas = vec![0.0; self.spacings.len()];
        for ((corners, _), area) in grid.cells().zip(&self.areas) {
            corners.into_iter().for_each(|at| areas[at as usize] += 0.25 * area);
        }
        areas
    }
}

#[cfg(test)]
mod tests {
    use super::CellSizes;
    use crate::fabric::grid::Grid;

    #[test]
    fn a_regular_grid_has_the_sizes_of_its_spacing() {
        let grid = Grid::new(4, 5, 0.3, 0.8);
        let sizes = CellSizes::of(&grid, &grid.positions(), false);
        let close = |a: f32, b: f32| (a - b).abs() < 1e-6;
        let areas = sizes.particle_areas(&grid);
        assert!(areas.iter().zip(grid.particle_areas()).all(|(&a, b)| close(a, b)), "{areas:?}");
        for (node, ([along, across], [of_row, of_column])) in
            sizes.spacings.iter().zip(&sizes.widths).enumerate()
        {
            let (column, row) = (node % 4, node / 4);
            let part = |at: usize, count: usize| if at == 0 || at + 1 == count { 0.5 } else { 1.0 };
            assert!(close(*along, 0.1) && close(*across, 0.2), "{along} {across}");
            assert!(close(*of_row, 0.2 * part(row, 5)) && close(*of_column, 0.1 * part(column, 4)));
        }
    }
}
