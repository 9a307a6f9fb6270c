//! The nodes of a grid on a chart: where they lie, which particles they are read from, and how much cloth is around them.

use std::collections::BTreeMap;

use glam::Vec2;

use super::chart::{Chart, node_positions};
use super::coverage::Coverage;
use super::interpolation::{Interpolation, Term, nodes_from_particles};
use super::on_chart::OnChart;
use super::whole::is_whole;
use super::{coverage, cut, moved, smooth};
use crate::fabric::grid::Grid;
use crate::fabric::laid_yarns::Faces;

/// Greatest distance of a node that stands for pins from these, in cells. Larger: in triangles of several cells the nodes beside pins
/// are held, too, and a cloth that hangs from coarse triangles stretches too little (a sheet of 17² vertices graded 1 : 10 by 16 %).
/// Smaller: nodes beside pins of even meshes are not held.
const NEAR_PINS: f32 = 0.95;

/// The nodes of a grid on a chart.
pub(super) struct LaidNodes {
    /// Of each node the places of the chart that it is read from.
    pub rows: Interpolation,
    /// Of each node its own place.
    pub places: Vec<Vec2>,
    /// Whether each node lies outside the mesh.
    pub is_outside: Vec<bool>,
    /// Whether each node lies as near to pins as one that stands for them.
    pub is_near_pins: Vec<bool>,
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
        let mut is_near_pins = near_pins(&rows, positions, grid, is_free);
        pins.keys().for_each(|&node| is_near_pins[node as usize] = true);
        if chart.plane.is_none() {
            rows = smooth::smoothed(rows, chart, grid, is_free, &is_near_pins);
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
            is_near_pins,
            are_moved: !pins.is_empty(),
        })
    }
}

/// Whether each node lies near the pinned places that it is read from, or is read from none.
fn near_pins(rows: &Interpolation, positions: &[Vec2], grid: &Grid, is_free: &[bool]) -> Vec<bool> {
    let spacing = Vec2::from(grid.spacing());
    let of_node = |(node, row): (Vec2, &[Term])| {
        let pinned = || row.iter().filter(|term| !is_free[term.from as usize]);
        let weight: f32 = pinned().map(|term| term.weight).sum();
        let middle: Vec2 = pinned().map(|term| positions[term.from as usize] * term.weight).sum();
        weight <= 0.0 || ((node - middle / weight) / spacing).length() < NEAR_PINS
    };
    node_positions(grid).into_iter().zip(rows.rows()).map(of_node).collect()
}
