//! A mesh on a chart, and how its grid is found there.

use super::BackgroundMesh;
use super::chart::Chart;
use super::coverage::{self, Coverage};
use super::hold::Hold;
use super::laid_nodes::LaidNodes;
use crate::fabric::grid::Grid;
use crate::fabric::mesh::{RestMesh, Surface};

/// A mesh on a chart, with the grid over it.
pub(super) struct OnChart<'a> {
    pub mesh: &'a RestMesh,
    pub surface: &'a Surface,
    /// The surface with its whole texture, if that has pieces with different warps.
    pub of_pieces: Option<&'a Surface>,
    pub chart: Chart,
    pub grid: Grid,
    /// Whether the particle at each place of the chart is free.
    pub is_free: Vec<bool>,
    /// How much of each cell is cloth.
    pub coverage: Coverage,
}

impl<'a> OnChart<'a> {
    /// None if the mesh overlaps itself.
    pub fn of(
        mesh: &'a RestMesh,
        surface: &'a Surface,
        of_pieces: Option<&'a Surface>,
        chart: Chart,
    ) -> Option<Self> {
        let grid = chart.grid();
        let coverage = coverage::once(&chart.positions, &chart.triangles, &grid, None)?;
        let is_free = chart.particles.iter().map(|&at| !mesh.is_pinned(at)).collect();
        Some(Self { mesh, surface, of_pieces, chart, grid, is_free, coverage })
    }

    /// The grid of the mesh; none if it does not hold the mesh where its pins do. Some nodes are moved to pins if these lie
    /// between nodes.
    pub fn background(&self) -> Option<BackgroundMesh> {
        let straight = BackgroundMesh::on(self, LaidNodes::of(self)?);
        let hold = |found: &BackgroundMesh| Hold::of(self, &found.mesh);
        if straight.as_ref().is_some_and(|found| hold(found) == Hold::AtPins) {
            return straight;
        }
        let moved = LaidNodes::moved_to_pins(self);
        let moved = moved.and_then(|laid| BackgroundMesh::on(self, laid));
        let is_held = |found: &BackgroundMesh| hold(found) != Hold::Loose;
        moved.filter(is_held).or_else(|| straight.filter(is_held))
    }
}
