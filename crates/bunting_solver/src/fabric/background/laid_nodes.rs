//! The nodes of a grid on a chart: where they lie, which particles they are read from, and how much cloth is around them.

use glam::Vec2;

use super::chart::{Chart, node_positions};
use super::coverage::{self, Coverage};
use super::interpolation::{Interpolation, nodes_from_particles};
use super::{cut, moved, smooth};
use crate::fabric::cell_sizes::CellSizes;
use crate::fabric::grid::Grid;
use crate::fabric::mesh::Surface;

/// The nodes of a grid on a chart.
#[derive(Clone)]
pub(super) struct LaidNodes {
    /// Of each node the places of the chart that it is read from.
    pub rows: Interpolation,
    /// Of each node its own place.
    pub places: Vec<Vec2>,
    /// Whether each node lies outside the mesh.
    pub is_outside: Vec<bool>,
    /// The part of each cell that counts as cloth.
    pub parts: Vec<f32>,
    /// Whether there is cloth in each cell.
    pub cells_with_cloth: Vec<bool>,
    /// Whether there is cloth around each node.
    pub has_cloth: Vec<bool>,
    /// The sizes of cells of which only a part may be cloth.
    pub cut_cells: Option<CellSizes>,
    /// Whether some nodes are moved to pins.
    pub are_moved: bool,
}

impl LaidNodes {
    /// The nodes of a grid that the mesh fills; none if it does not, or overlaps itself.
    pub fn filled(chart: &Chart, grid: &Grid, is_free: &[bool]) -> Option<Self> {
        let Chart { positions: places, triangles, .. } = chart;
        let coverage = coverage::once(places, triangles, grid)?;
        if !coverage.is_filled {
            return None;
        }
        let mut rows = nodes_from_particles(places, triangles, grid);
        if rows.rows().any(|row| row.is_empty()) {
            return None;
        }
        if chart.plane.is_none() {
            rows = smooth::smoothed(rows, places, grid, is_free);
        }
        Some(Self::new(rows, coverage, grid))
    }

    /// The nodes of a grid that may reach beyond the border of a flat mesh, and across its holes; none if it overlaps itself,
    /// or the grid would sew up a slit.
    pub fn cut(surface: &Surface, chart: &Chart, grid: &Grid, is_free: &[bool]) -> Option<Self> {
        // Nodes beyond the border of a curved mesh would have no place that is known.
        chart.plane.as_ref()?;
        let Chart { positions: places, triangles, .. } = chart;
        let coverage = coverage::once(places, triangles, grid)?;
        if !coverage.is_filled && !cut::is_whole(&coverage, grid, triangles.len(), &surface.edges) {
            return None;
        }
        let rows = nodes_from_particles(places, triangles, grid);
        let mut laid = Self::new(rows, coverage, grid);
        laid.rows = cut::extrapolated(laid.rows, places, is_free, &laid.has_cloth, grid);
        laid.cut_cells = Some(CellSizes::covered(grid, &laid.parts));
        Some(laid)
    }

    fn new(rows: Interpolation, coverage: Coverage, grid: &Grid) -> Self {
        let mut has_cloth = vec![false; (grid.columns * grid.rows) as usize];
        let cells = grid.cells().zip(&coverage.has_cloth).filter(|(_, has_cloth)| **has_cloth);
        cells.flat_map(|((corners, _), _)| corners).for_each(|at| has_cloth[at as usize] = true);
        Self {
            is_outside: rows.rows().map(|row| row.is_empty()).collect(),
            rows,
            places: node_positions(grid),
            has_cloth,
            cells_with_cloth: coverage.has_cloth,
            parts: coverage.parts,
            cut_cells: None,
            are_moved: false,
        }
    }

    /// The same nodes, those nearest to pins moved to these.
    pub fn moved_to_pins(mut self, chart: &Chart, grid: &Grid, is_free: &[bool]) -> Self {
        let places_of_nodes = moved::to_pins(chart, grid, is_free);
        self.rows = moved::rows(self.rows, &places_of_nodes);
        for (node, place) in places_of_nodes {
            self.places[node as usize] = chart.positions[place as usize];
            self.is_outside[node as usize] = false;
        }
        moved::rescale(&mut self.parts, grid, &self.places);
        self.are_moved = true;
        self
    }
}
