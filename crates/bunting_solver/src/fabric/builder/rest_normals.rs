//! Normals of a mesh that need not be a fabric.

use glam::Vec3;

use super::FabricBuilder;
use crate::fabric::{FabricError, weld};

impl FabricBuilder {
    /// Unit normals at rest, one a vertex, to the front; vertices that a fabric would merge share
    /// theirs. Triangles without area and edges of many triangles are no error here.
    ///
    /// # Errors
    ///
    /// A [`FabricError`] where the lists do not fit one another, or a position is not finite.
    pub fn rest_normals(&self) -> Result<Vec<Vec3>, FabricError> {
        self.validate()?;
        let distance = self.weld_distance.unwrap_or_else(|| self.default_weld());
        let welded = weld::weld(&self.positions, distance);
        let particle = |vertex: u32| welded.particle_of_vertex[vertex as usize] as usize;
        let mut sums = vec![Vec3::ZERO; welded.vertex_of_particle.len()];
        for corners in self.indices.chunks_exact(3) {
            let [a, b, c] = [0, 1, 2].map(|corner| self.positions[corners[corner] as usize]);
            // Twice the area long.
            let normal = (b - a).cross(c - a);
            for &corner in corners {
                sums[particle(corner)] += normal;
            }
        }
        let sums = welded.particle_of_vertex.iter().map(|&particle| sums[particle as usize]);
        Ok(sums.map(Vec3::normalize_or_zero).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_roof_is_smooth_across_its_seam() {
        let (ridge, far) = (Vec3::Y, Vec3::new(0.0, 1.0, 1.0));
        // Each side has vertices of its own along the ridge.
        let positions = vec![-Vec3::X, far, ridge, Vec3::X, ridge, far];
        let normals = FabricBuilder::new(positions, vec![0, 1, 2, 3, 4, 5]).rest_normals();
        let normals = normals.expect("a roof");
        let slope = Vec3::new(-1.0, 1.0, 0.0).normalize();
        assert!((normals[0] - slope).length() < 1e-6, "{normals:?}");
        assert!([1, 2, 4, 5].iter().all(|&vertex| (normals[vertex] - Vec3::Y).length() < 1e-6));
    }
}
