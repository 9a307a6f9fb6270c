//! Sizes of the cells of a grid that differ: its lines are curved and unevenly far apart, or only a part of a cell is cloth.

use glam::Vec3;

use super::grid::Grid;

/// The sizes of a grid's cells, and what follows from them at its particles.
#[derive(Clone, Debug)]
pub(super) struct CellSizes {
    /// Area of cloth in each cell, m².
    pub areas: Vec<f32>,
    /// Area of each cell, m².
    whole: Vec<f32>,
    /// Whether the first and the last row are at one place.
    is_closed: bool,
    /// Stiffness of each cell against twist, in units of the material's bending stiffness, 1/m².
    pub twists: Vec<f32>,
    /// Of each particle the mean distance of its neighbours in its row, and in its column, m, of those to which there is cloth.
    pub spacings: Vec<[f32; 2]>,
    /// Of each particle the width of cloth that its row stands for there, and its column, m.
    pub widths: Vec<[f32; 2]>,
}

impl CellSizes {
    /// The sizes at positions at rest, m, given the part of each cell that is cloth. The first and the last row of a closed grid
    /// are at one place, and each stands for the cells on one side.
    pub fn of(grid: &Grid, positions: &[Vec3], is_closed: bool, parts: &[f32]) -> Self {
        let area = |(corners, _): ([u32; 4], bool)| {
            let [a, b, c, d] = corners.map(|at| positions[at as usize]);
            0.5 * (d - a).cross(c - b).length()
        };
        // Nodes without cloth are anywhere.
        let [dx, dy] = grid.spacing();
        let cells = grid.cells().zip(parts);
        let whole = cells.map(|(cell, part)| if *part > 0.0 { area(cell) } else { dx * dy });
        let whole: Vec<f32> = whole.collect();
        let (mut spacings, mut widths) = (Vec::new(), Vec::new());
        for node in 0..grid.columns * grid.rows {
            let (column, row) = (node % grid.columns, node / grid.columns);
            let neighbours = grid.neighbours((column, row), is_closed);
            let distances = neighbours
                .map(|other| positions[node as usize].distance(positions[other as usize]));
            let [before, after, above, below] = distances;
            let cell =
                |right: bool, down: bool| cell_beside(grid, (column, row), right, down, is_closed);
            let part = |right, down| cell(right, down).map_or(0.0, |cell| parts[cell]);
            // Widths of the links of the row before and after the node, and of the column above and below it.
            let of_row = [false, true]
                .map(|right| 0.5 * (above * part(right, false) + below * part(right, true)));
            let of_column = [false, true]
                .map(|down| 0.5 * (before * part(false, down) + after * part(true, down)));
            let exist = neighbours.map(|other| other != node);
            let at_seam = is_closed && (row == 0 || row + 1 == grid.rows);
            let row_width = narrower(of_row, [exist[0], exist[1]]);
            widths.push([
                if at_seam { 0.5 * row_width } else { row_width },
                narrower(of_column, [exist[2], exist[3]]),
            ]);
            spacings.push([mean([before, after], of_row, dx), mean([above, below], of_column, dy)]);
        }
        let twist =
            |(whole, part): (&f32, &f32)| if *part > 0.0 { 2.0 * part / whole } else { 0.0 };
        Self {
            twists: whole.iter().zip(parts).map(twist).collect(),
            areas: whole.iter().zip(parts).map(|(whole, part)| whole * part).collect(),
            whole,
            is_closed,
            spacings,
            widths,
        }
    }

    /// The part of each particle's cells that is cloth.
    pub fn parts_of_particles(&self, grid: &Grid) -> Vec<f32> {
        let part = |(cloth, whole): (f32, f32)| if cloth > 0.0 { cloth / whole } else { 0.0 };
        let whole = self.quarters(grid, &self.whole);
        self.particle_areas(grid).into_iter().zip(whole).map(part).collect()
    }

    /// Area of each particle, m²: a quarter of the cloth in each cell that it borders. Two at one place have half of it each.
    pub fn particle_areas(&self, grid: &Grid) -> Vec<f32> {
        self.quarters(grid, &self.areas)
    }

    fn quarters(&self, grid: &Grid, of_cells: &[f32]) -> Vec<f32> {
        let mut areas = vec![0.0; self.spacings.len()];
        for ((corners, _), area) in grid.cells().zip(of_cells) {
            corners.into_iter().for_each(|at| areas[at as usize] += 0.25 * area);
        }
        if self.is_closed {
            for ends in grid.ends_of_columns() {
                let [first, last] = ends.map(|end| areas[end as usize]);
                ends.iter().for_each(|&end| areas[end as usize] = 0.5 * (first + last));
            }
        }
        areas
    }
}

/// The cell to the right of a node or to its left, and below it or above; none beyond the grid.
fn cell_beside(
    grid: &Grid,
    (column, row): (u32, u32),
    right: bool,
    down: bool,
    is_closed: bool,
) -> Option<usize> {
    let (columns, rows) = (grid.columns - 1, grid.rows - 1);
    let beside = |at: u32, forwards: bool| if forwards { Some(at) } else { at.checked_sub(1) };
    let column = beside(column, right).filter(|&column| column < columns)?;
    let row = if is_closed {
        (row + rows - u32::from(!down)) % rows
    } else {
        beside(row, down).filter(|&row| row < rows)?
    };
    Some((row * columns + column) as usize)
}

/// The smaller of two widths, of those that exist: a line is as wide at a node as the narrower of its links there.
fn narrower([one, other]: [f32; 2], exist: [bool; 2]) -> f32 {
    match exist {
        [true, true] => one.min(other),
        [true, false] => one,
        [false, _] => other,
    }
}

/// The mean of the lengths of the links that have a width, m; if none has, that of a cell.
fn mean([one, other]: [f32; 2], [of_one, of_other]: [f32; 2], of_cell: f32) -> f32 {
    match [of_one > 0.0, of_other > 0.0] {
        [true, true] => 0.5 * (one + other),
        [true, false] => one,
        [false, true] => other,
        [false, false] => of_cell,
    }
}

#[cfg(test)]
mod tests {
    use super::CellSizes;
    use crate::fabric::grid::Grid;

    #[test]
    fn a_regular_grid_has_the_sizes_of_its_spacing() {
        let grid = Grid::new(4, 5, 0.3, 0.8);
        let sizes = CellSizes::of(&grid, &grid.positions(), false, &[1.0; 12]);
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
