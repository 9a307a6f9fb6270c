//! The steps from a builder to a fabric.

use super::resampled::{Resolution, check_sides};
use super::source::FabricBuilder;
use crate::fabric::error::FabricError;
use crate::fabric::fabric::Fabric;
use crate::fabric::grid::Grid;
use crate::fabric::interpolation::Term;
use crate::fabric::mesh::{RestMesh, Surface};

impl FabricBuilder {
    /// Builds the fabric: of a grid one whose particles are the grid's, of any other mesh one with particles of its own, at the
    /// default [`Resolution`]. [`resampled`](Self::resampled) tells how such a mesh follows its particles, too.
    ///
    /// # Errors
    ///
    /// A [`FabricError`] names the defect of the mesh and its location.
    pub fn build(self) -> Result<Fabric, FabricError> {
        let Some(grid) = self.own_grid() else {
            let count = self.grid.map(|Grid { columns, rows, .. }| columns * rows);
            let resolution = count.map_or(Resolution::default(), Resolution::Particles);
            return self.laid(resolution).map(|laid| laid.fabric);
        };
        let (mesh, surface) = self.rest_mesh()?;
        let count = self.positions.len() as u32;
        let itself = || (0..count).map(|from| vec![Term { from, weight: 1.0 }]).collect();
        let variation = self.variation_of_grid(&mesh, &surface, &grid, itself);
        Ok(Fabric::of_grid(mesh, &surface, grid, 1.0, &variation, self.tethered))
    }

    /// Checks the mesh, which takes much less time than to build a fabric.
    ///
    /// # Errors
    ///
    /// Those of [`build`](Self::build), but for [`FabricError::Cells`].
    pub fn check(&self) -> Result<(), FabricError> {
        let (mesh, surface) = self.rest_mesh()?;
        if self.own_grid().is_some() {
            return Ok(());
        }
        check_sides(&mesh, &surface, &self.weld().vertex_of_particle)
    }

    /// The mesh with its vertices merged.
    pub(in crate::fabric) fn rest_mesh(&self) -> Result<(RestMesh, Surface), FabricError> {
        self.validate()?;
        let pinned = self.pinned.iter().copied();
        RestMesh::new(&self.positions, &self.uv, &self.indices, pinned, self.weld())
    }
}

#[cfg(test)]
mod tests {
    use glam::{Vec2, Vec3};

    use crate::fabric::{FabricBuilder, FabricError, Grid};

    const QUAD: [Vec3; 4] = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(1.0, 1.0, 0.0)];

    fn error(positions: &[Vec3], indices: &[u32]) -> FabricError {
        let builder = FabricBuilder::new(positions.to_vec(), indices.to_vec());
        let error = builder.clone().build().expect_err("a bad mesh");
        assert_eq!(builder.check(), Err(error));
        error
    }

    #[test]
    fn bad_meshes_say_where() {
        assert_eq!(error(&QUAD, &[]), FabricError::Empty);
        assert_eq!(error(&QUAD, &[0, 1, 2, 3]), FabricError::IndexCount { count: 4 });
        assert_eq!(
            error(&QUAD, &[0, 1, 2, 1, 9, 2]),
            FabricError::IndexOutOfRange { triangle: 1, vertex: 9, vertices: 4 }
        );
        let mut infinite = QUAD;
        infinite[2].y = f32::INFINITY;
        assert_eq!(error(&infinite, &[0, 1, 2]), FabricError::NotFinite { vertex: 2 });
        let quad = || FabricBuilder::new(QUAD.to_vec(), vec![0, 1, 2, 1, 3, 2]);
        let uv = vec![Vec2::ZERO, Vec2::X, Vec2::Y, Vec2::new(1.0, f32::NAN)];
        let bad_uv = quad().uv(uv).build();
        assert_eq!(bad_uv.expect_err("a bad uv"), FabricError::UvNotFinite { vertex: 3 });
        let welded = quad().weld_distance(f32::NAN).build();
        assert!(matches!(welded, Err(FabricError::WeldDistance { .. })));
        assert_eq!(error(&QUAD, &[0, 1, 2, 1, 1, 3]), FabricError::ZeroArea { triangle: 1 });
        assert_eq!(error(&QUAD, &[0, 1, 2]), FabricError::LooseVertex { vertex: 3 });
        let fan = [QUAD[0], QUAD[1], QUAD[2], QUAD[3], Vec3::Z];
        assert_eq!(
            error(&fan, &[1, 2, 0, 1, 2, 3, 1, 2, 4]),
            FabricError::NonManifoldEdge { a: 1, b: 2 }
        );
        let late = quad().pin_where(|_, uv| uv.x == 0.0).uv(vec![Vec2::ONE; 4]).build();
        assert_eq!(late.expect_err("pins by no uv"), FabricError::PinnedBeforeUv);
        let pinned = FabricBuilder::new(QUAD.to_vec(), vec![0, 1, 2, 1, 3, 2]).pin([4]).build();
        assert_eq!(
            pinned.expect_err("a bad pin"),
            FabricError::PinOutOfRange { vertex: 4, vertices: 4 }
        );
        let grid = FabricBuilder::grid(Grid::new(1, 5, 1.0, 1.0)).build();
        assert!(matches!(grid, Err(FabricError::Grid { columns: 1, .. })));
    }

    #[test]
    fn all_pinned_is_allowed_and_has_nothing_to_solve() {
        let fabric = FabricBuilder::grid(Grid::new(3, 3, 1.0, 1.0))
            .pin(0..9)
            .build()
            .expect("a good fabric");
        assert!(fabric.links().is_empty() && fabric.hinges().is_empty());
    }
}
