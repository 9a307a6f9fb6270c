//! Whether a grid holds together only what hangs together in its mesh.
//!
//! The two sides of a slit hang by the same nodes where these lie between them: the grid would sew the slit up.

use super::chart::Chart;
use super::coverage::Coverage;
use crate::fabric::grid::Grid;
use crate::fabric::laid_yarns::Faces;

/// Least part of the grid's cells with cloth. Smaller: nodes without cloth take more time than laid yarns.
const LEAST_FILLED: f32 = 0.25;

/// How much farther than the cells around a node the ways between the triangles in these may run, in cells. Smaller: ragged borders
/// count as slits: with 1, those of a fifth of 80 flat meshes at random. Larger: short slits are closed.
const FARTHER: i64 = 2;

/// Whether what of a mesh lies in the cells around each node hangs together in them and in the next ones.
pub(super) fn is_whole(chart: &Chart, coverage: &Coverage, grid: &Grid, faces: &Faces) -> bool {
    if chart.has_seam() {
        // The two sides of a seam hang together, but not in the grid.
        return coverage.is_filled;
    }
    let with_cloth = coverage.has_cloth.iter().filter(|has_cloth| **has_cloth).count();
    if (with_cloth as f32) < LEAST_FILLED * coverage.parts.len() as f32 {
        return false;
    }
    let in_cell = |cell: usize| {
        let triangles = coverage.triangles[cell].iter();
        triangles.map(|&triangle| chart.of_mesh[triangle as usize])
    };
    let is_at_border = |triangle: u32| faces.neighbours(triangle).count() < 3;
    let has_border: Vec<bool> =
        (0..coverage.triangles.len()).map(|cell| in_cell(cell).any(is_at_border)).collect();
    let around = Around { grid, is_closed: chart.is_closed };
    let mut is_near = vec![false; faces.count()];
    let (mut next, mut near) = (Vec::new(), Vec::new());
    (0..grid.columns * grid.rows).all(|node| {
        if !around.cells(node, 1 + FARTHER).any(|cell| has_border[cell]) {
            return true;
        }
        let triangles = |reach| around.cells(node, reach).flat_map(in_cell);
        let Some(first) = triangles(1).next() else { return true };
        near.clear();
        near.extend(triangles(1 + FARTHER));
        near.iter().for_each(|&triangle| is_near[triangle as usize] = true);
        next.push(first);
        while let Some(triangle) = next.pop() {
            if core::mem::replace(&mut is_near[triangle as usize], false) {
                next.extend(faces.neighbours(triangle));
            }
        }
        let is_whole = !triangles(1).any(|triangle| is_near[triangle as usize]);
        near.iter().for_each(|&triangle| is_near[triangle as usize] = false);
        is_whole
    })
}

/// The cells around the nodes of a grid.
struct Around<'a> {
    grid: &'a Grid,
    /// Whether the cells of the last row are beside those of the first.
    is_closed: bool,
}

impl Around<'_> {
    /// The cells up to so many columns and rows from a node.
    fn cells(&self, node: u32, reach: i64) -> impl Iterator<Item = usize> {
        let [columns, rows] = [self.grid.columns, self.grid.rows].map(i64::from);
        let [column, row] = [node % self.grid.columns, node / self.grid.columns].map(i64::from);
        let (columns, rows) = (columns - 1, rows - 1);
        let is_closed = self.is_closed;
        let lines = (row - reach..row + reach).filter_map(move |line| {
            let is_within = (0..rows).contains(&line);
            (is_within || is_closed).then(|| line.rem_euclid(rows))
        });
        let within = (column - reach).max(0)..(column + reach).min(columns);
        lines.flat_map(move |line| within.clone().map(move |at| (line * columns + at) as usize))
    }
}
