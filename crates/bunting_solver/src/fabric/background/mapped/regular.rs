//! Whether the cells of a mapped grid are enough like rectangles, and like one another.

use crate::fabric::grid::Grid;
use crate::fabric::mesh::RestMesh;

/// Least sine of the angles of a cell. Smaller: rows and columns carry load that shear should carry.
const LEAST_SINE: f32 = 0.8;

/// Greatest ratio of the sides of a cell. Larger: diagonals run along the sides.
const LONGEST: f32 = 3.0;

/// Greatest ratio of the areas of cells that share a side. Larger: lines of nodes have jumps of mass and stiffness.
const UNLIKE: f32 = 2.5;

/// Least part of the mean area that a cell has. Smaller: the shortest links ask for more substeps than laid yarns.
const LEAST_AREA: f32 = 0.05;

/// Whether all cells of a grid in which there is cloth are near rectangles, and neighbours are alike.
pub(in super::super) fn is_regular(grid: &Grid, nodes: &RestMesh, has_cloth: &[bool]) -> bool {
    let cell = |corners: [u32; 4]| {
        let [a, b, c, d] = nodes.positions_of(corners);
        let [right, down] = [(b - a) + (d - c), (c - a) + (d - b)].map(|side| 0.5 * side);
        let area = right.cross(down).length();
        let sine = area / (right.length() * down.length());
        let ratio = right.length() / down.length();
        let is_good = sine > LEAST_SINE && ratio < LONGEST && ratio > 1.0 / LONGEST;
        is_good.then_some(area)
    };
    let with_cloth = || grid.cells().zip(has_cloth).filter(|(_, has_cloth)| **has_cloth);
    let areas: Option<Vec<f32>> = with_cloth().map(|((corners, _), _)| cell(corners)).collect();
    let Some(areas) = areas else { return false };
    let mean = areas.iter().sum::<f32>() / areas.len() as f32;
    if areas.iter().any(|&area| area <= LEAST_AREA * mean) {
        return false;
    }
    // Cells without cloth have no area.
    let mut of_cells = vec![0.0; has_cloth.len()];
    let cells = of_cells.iter_mut().zip(has_cloth).filter(|(_, has_cloth)| **has_cloth);
    cells.zip(&areas).for_each(|((of_cell, _), area)| *of_cell = *area);
    let columns = (grid.columns - 1) as usize;
    let is_alike =
        |one: f32, other: f32| one * other == 0.0 || (one < UNLIKE * other && other < UNLIKE * one);
    let rows = of_cells.chunks(columns);
    let along = rows.clone().all(|row| row.windows(2).all(|two| is_alike(two[0], two[1])));
    let below = of_cells.iter().zip(&of_cells[columns..]);
    along && below.into_iter().all(|(&one, &other)| is_alike(one, other))
}
