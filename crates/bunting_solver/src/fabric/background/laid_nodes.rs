//! The nodes of a grid on a chart: where they lie, which particles they are read from, and how much cloth is around them.

use glam::Vec2;

use super::chart::{Chart, node_positions};
use super::interpolation::{Interpolation, nodes_from_particles};
use super::{coverage, cut, moved, smooth};
use crate::fabric::cell_sizes::CellSizes;
use crate::fabric::grid::Grid;
use crate::fabric::mesh::Surface;

/// How closely a grid follows its mesh.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Fit {
    /// The mesh fills the grid.
    Filled,
    /// The grid may reach beyond the border of the mesh, and across its holes.
    Cut,
    /// The same, and the nodes nearest to pins are moved to them.
    Moved,
}

/// The nodes of a grid on a chart.
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
    pub has_cloth: Vec<bool>,
    /// The sizes of cells of which only a part may be cloth.
    pub cut_cells: Option<CellSizes>,
}

impl LaidNodes {
    /// The nodes of a grid; none if the mesh overlaps itself, or the grid does not fit as it should.
    pub fn of(
        surface: &Surface,
        chart: &Chart,
        grid: &Grid,
        is_free: &[bool],
        fit: Fit,
    ) -> Option<Self> {
        // Nodes beyond the border of a curved mesh would have no place that is known.
        if fit != Fit::Filled && chart.plane.is_none() {
            return None;
        }
        let Chart { positions: places, triangles, .. } = chart;
        let coverage = coverage::once(places, triangles, grid)?;
        let mut rows = nodes_from_particles(places, triangles, grid);
        let is_outside: Vec<bool> = rows.rows().map(|row| row.is_empty()).collect();
        if coverage.is_filled {
            if is_outside.contains(&true) {
                return None;
            }
            if chart.plane.is_none() {
                rows = smooth::smoothed(rows, places, grid, is_free);
            }
        } else {
            if fit == Fit::Filled || !cut::is_whole(&coverage, grid, &surface.edges) {
                return None;
            }
            rows = cut::extrapolated(rows, places, is_free, grid);
        }
        let is_cut = fit == Fit::Moved || !coverage.is_filled;
        let laid = Self {
            rows,
            places: node_positions(grid),
            is_outside,
            has_cloth: (0..coverage.parts.len()).map(|cell| coverage.has_cloth(cell)).collect(),
            cut_cells: is_cut.then(|| CellSizes::covered(grid, &coverage.parts)),
            parts: coverage.parts,
        };
        Some(if fit == Fit::Moved { laid.moved_to_pins(chart, grid, is_free) } else { laid })
    }

    /// The same nodes, but for those that pins take with them.
    fn moved_to_pins(mut self, chart: &Chart, grid: &Grid, is_free: &[bool]) -> Self {
        let places_of_nodes = moved::to_pins(chart, grid, is_free);
        self.rows = moved::rows(self.rows, &places_of_nodes);
        for (node, place) in places_of_nodes {
            self.places[node as usize] = chart.positions[place as usize];
            self.is_outside[node as usize] = false;
        }
        moved::enlarge(&mut self.parts, grid, &self.places);
        self
    }
}
