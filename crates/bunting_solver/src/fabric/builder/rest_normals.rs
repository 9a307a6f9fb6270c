//! Normals of a mesh without a fabric.

use glam::Vec3;

use super::source::FabricBuilder;
use crate::fabric::error::FabricError;
use crate::fabric::normals::vertex_normals;

impl FabricBuilder {
    /// Unit normals at rest, one for each vertex, on the front side. Vertices that a fabric would merge have
    /// the same normal. Triangles without area and edges of more than two triangles are accepted here.
    ///
    /// # Errors
    ///
    /// The lists do not fit one another, or a position is not finite.
    pub fn rest_normals(&self) -> Result<Vec<Vec3>, FabricError> {
        self.validate()?;
        let welded = self.weld();
        let triangles = self.indices.chunks_exact(3).map(|corners| {
            let vertices = [corners[0], corners[1], corners[2]].map(|vertex| vertex as usize);
            let particles = vertices.map(|vertex| welded.particle_of_vertex[vertex]);
            (vertices.map(|vertex| self.positions[vertex]), particles)
        });
        let normals = vertex_normals(welded.vertex_of_particle.len(), triangles);
        let particles = welded.particle_of_vertex.iter();
        Ok(particles.map(|&particle| normals[particle as usize]).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fabric::{Grid, Resampled, Resolution};

    /// The carried vertices of a mesh at rest have the same normals.
    #[test]
    fn carried_vertices_have_the_normals_of_their_mesh() {
        let grid = Grid::new(5, 4, 1.0, 1.0);
        let bent = grid.positions().iter().map(|at| at.with_z(at.x * at.x - 0.3 * at.y)).collect();
        let triangles = grid.triangles(false).into_flattened();
        let builder = FabricBuilder::new(bent, triangles);
        let normals = builder.rest_normals().expect("a mesh");
        let Resampled { fabric, carried, .. } =
            builder.resampled(Resolution::CellSize(0.1)).expect("a mesh");
        let found = carried.normals(&carried.places(fabric.rest_positions()));
        let pairs = found.iter().zip(&normals);
        assert!(pairs.into_iter().all(|(found, normal)| found.distance(*normal) < 1e-4));
        assert!(normals.iter().all(|normal| normal.z > 0.3), "to the front");
    }

    #[test]
    fn a_roof_is_smooth_across_its_seam() {
        let (ridge, far) = (Vec3::Y, Vec3::new(0.0, 1.0, 1.0));
        // Each side of the roof has its own vertices along the ridge.
        let positions = vec![-Vec3::X, far, ridge, Vec3::X, ridge, far];
        let normals = FabricBuilder::new(positions, vec![0, 1, 2, 3, 4, 5]).rest_normals();
        let normals = normals.expect("a roof");
        let slope = Vec3::new(-1.0, 1.0, 0.0).normalize();
        assert!((normals[0] - slope).length() < 1e-6, "{normals:?}");
        assert!([1, 2, 4, 5].iter().all(|&vertex| (normals[vertex] - Vec3::Y).length() < 1e-6));
    }
}
