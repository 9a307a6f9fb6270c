//! The nodes of a grid on a chart: where they lie, which particles they are read from, and how much cloth is around them.

use std::collections::BTreeMap;

use glam::Vec2;

use super::chart::{Chart, node_positions};
use super::coverage::Coverage;
use super::interpolation::{Interpolation, nodes_from_particles};
use super::on_chart::OnChart;
use super::whole::is_whole;
use super::{coverage, cut, moved, smooth};
use crate::fabric::laid_yarns::Faces;

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
    /// The triangles of the chart in each cell.
    pub triangles: Vec<Vec<u32>>,
    /// Whether there is cloth in each cell.
    pub cells_with_cloth: Vec<bool>,
    /// Whether there is cloth around each node.
    pub has_cloth: Vec<bool>,
    /// Whether some nodes lie outside the mesh, or some cells are not filled.
    pub are_cut: bool,
    /// Whether some nodes are moved to pins.
    pub are_moved: bool,
}

impl LaidNodes {
    /// The nodes of a grid, which may reach beyond the border of a mesh and across its holes; none if that would sew up a slit.
    pub fn of(on: &OnChart) -> Option<Self> {
        Self::at(on, node_positions(&on.grid), on.coverage.clone(), &BTreeMap::new())
    }

    /// The same, with the nodes nearest to pins moved to these; none also if cells between them are turned over.
    pub fn moved_to_pins(on: &OnChart) -> Option<Self> {
        let OnChart { chart, grid, is_free, .. } = on;
        let pins = moved::to_pins(chart, grid, is_free);
        let places = moved::places(chart, grid, &pins);
        let coverage = coverage::once(&chart.positions, &chart.triangles, grid, Some(&places))?;
        Self::at(on, places, coverage, &pins)
    }

    /// Whether there is cloth around all corners of a cell.
    pub fn have_cloth(&self, corners: &[u32; 4]) -> bool {
        corners.iter().all(|&node| self.has_cloth[node as usize])
    }

    /// Nodes at their places, of which some are those of pins.
    fn at(
        OnChart { mesh, surface, chart, grid, is_free, .. }: &OnChart,
        places: Vec<Vec2>,
        coverage: Coverage,
        pins: &BTreeMap<u32, u32>,
    ) -> Option<Self> {
        let Chart { positions, triangles, .. } = chart;
        let faces = Faces::new(&mesh.positions, &mesh.triangles, &surface.edges);
        if !is_whole(chart, &coverage, grid, &faces) {
            return None;
        }
        let mut rows = nodes_from_particles(positions, triangles, grid);
        let is_outside: Vec<bool> = (0..)
            .zip(rows.rows())
            .map(|(node, row)| row.is_empty() && !pins.contains_key(&node))
            .collect();
        if chart.plane.is_none() {
            rows = smooth::smoothed(rows, positions, grid, is_free);
        }
        if !pins.is_empty() {
            rows = moved::rows(rows, pins);
        }
        let mut has_cloth = vec![false; (grid.columns * grid.rows) as usize];
        let cells = grid.cells().zip(&coverage.has_cloth).filter(|(_, has_cloth)| **has_cloth);
        cells.flat_map(|((corners, _), _)| corners).for_each(|at| has_cloth[at as usize] = true);
        if chart.is_closed {
            for ends in grid.ends_of_columns() {
                let has = ends.iter().any(|&end| has_cloth[end as usize]);
                ends.iter().for_each(|&end| has_cloth[end as usize] = has);
            }
        }
        let is_any_outside = is_outside.contains(&true);
        if is_any_outside {
            if chart.has_seam() {
                return None;
            }
            rows = cut::extrapolated(rows, chart, is_free, &has_cloth, grid)?;
        }
        Some(Self {
            rows,
            places,
            has_cloth,
            cells_with_cloth: coverage.has_cloth,
            parts: coverage.parts,
            triangles: coverage.triangles,
            are_cut: is_any_outside || !coverage.is_filled,
            is_outside,
            are_moved: !pins.is_empty(),
        })
    }
}
