//! The next coarser mesh of a chain of levels of detail.

use super::source::FabricBuilder;

/// A mesh with some of the vertices of a finer mesh, from [`FabricBuilder::coarser`].
///
/// ```
/// use bunting_solver::{FabricBuilder, Grid};
///
/// let fine = FabricBuilder::grid(Grid::new(9, 5, 2.0, 1.0)).pin([0]);
/// let coarse = fine.coarser().expect("the grid can be halved");
/// // The second vertex of the coarser grid is the third one of the finer grid.
/// assert_eq!(coarse.vertices[1], 2);
/// assert_eq!(coarse.builder.build()?.particle_count(), 5 * 3);
/// # Ok::<(), bunting_solver::FabricError>(())
/// ```
#[derive(Clone, Debug)]
pub struct CoarserMesh {
    /// The mesh, with those pins that remain.
    pub builder: FabricBuilder,
    /// For each vertex of the coarser mesh, the vertex of the finer mesh at the same position.
    pub vertices: Vec<u32>,
}

impl FabricBuilder {
    /// Builds the next coarser level of a grid: every second column and row. None if the grid cannot be halved, and of other meshes,
    /// whose coarser levels are [resampled](Self::resampled) in larger cells.
    #[must_use]
    pub fn coarser(&self) -> Option<CoarserMesh> {
        let grid = self.own_grid()?;
        let halved = grid.halved()?;
        let vertices: Vec<u32> = (0..halved.rows)
            .flat_map(|row| (0..halved.columns).map(move |column| (column, row)))
            .map(|(column, row)| grid.index(2 * column, 2 * row))
            .collect();
        let among = (0..).zip(&vertices).filter(|(_, vertex)| self.pinned.contains(vertex));
        let pins: Vec<u32> = among.map(|(at, _)| at).collect();
        // The grid may have been placed somewhere.
        let positions = vertices.iter().map(|&vertex| self.positions[vertex as usize]).collect();
        let regions = self.halved_regions(&grid, &halved);
        let builder = Self { positions, regions, ..Self::grid(halved) };
        let builder = builder.pin(pins).tethered(self.tethered);
        Some(CoarserMesh { builder, vertices })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fabric::Grid;

    #[test]
    fn an_untethered_fabric_has_no_tethers_at_any_level() {
        let grid = FabricBuilder::grid(Grid::new(9, 9, 1.0, 1.0)).pin([0, 8]);
        let coarser = grid.tethered(false).coarser().expect("a level").builder;
        let fabric = coarser.build().expect("a cloth");
        assert!(fabric.has_pins() && fabric.tethers().is_empty());
    }

    #[test]
    fn only_grids_that_can_be_halved_have_a_coarser_level() {
        let grid = Grid::new(9, 9, 1.0, 0.1);
        let triangles = grid.triangles(false).into_iter().flatten().collect();
        assert!(FabricBuilder::new(grid.positions(), triangles).coarser().is_none());
        assert!(FabricBuilder::grid(Grid::new(4, 5, 1.0, 1.0)).coarser().is_none());
        assert!(FabricBuilder::grid(grid).coarser().is_some());
    }
}
