//! Points on the triangles of a mesh, at which the fabric has particles.

use std::collections::HashMap;

use glam::Vec3;

use super::mesh_point::MeshPoint;
use super::source::FabricBuilder;
use crate::fabric::error::FabricError;
use crate::fabric::remesh::{PointOn, nearest_weights};

/// Greatest difference of the sum of a point's weights from 1. Larger: weights of another triangle pass. Smaller: those that a
/// file has rounded are refused.
const OFF: f32 = 1e-3;

impl FabricBuilder {
    /// Pins points on the triangles of the mesh, each by a particle of its own. Unlike vertices, two points hold nothing
    /// between them. A grid with points is [resampled](Self::resampled) as any other mesh, to about as many particles as it had.
    /// [`Fabric::particle_of_point`](crate::Fabric::particle_of_point) tells the particles.
    ///
    /// ```
    /// use bunting_solver::{FabricBuilder, MeshPoint};
    /// use glam::Vec3;
    ///
    /// // A triangle that hangs by its middle.
    /// let corners = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
    /// let triangle = FabricBuilder::new(corners, vec![0, 1, 2]);
    /// let fabric = triangle.pin_points([MeshPoint::middle([0, 1, 2])]).build()?;
    /// assert!(fabric.is_pinned(fabric.particle_of_point()[0] as usize));
    /// # Ok::<(), bunting_solver::FabricError>(())
    /// ```
    #[must_use]
    pub fn pin_points(mut self, points: impl IntoIterator<Item = MeshPoint>) -> Self {
        self.points.extend(points.into_iter().map(|point| (point, true)));
        self
    }

    /// Makes free particles at points on the triangles of the mesh, as for springs that hold these. Otherwise as
    /// [`pin_points`](Self::pin_points).
    #[must_use]
    pub fn free_points(mut self, points: impl IntoIterator<Item = MeshPoint>) -> Self {
        self.points.extend(points.into_iter().map(|point| (point, false)));
        self
    }

    /// The point of the mesh nearest to a position, m; none without triangles.
    #[must_use]
    pub fn nearest_point(&self, to: Vec3) -> Option<MeshPoint> {
        let triangles = self.indices.as_chunks::<3>().0.iter();
        let of_triangle = |&vertices: &[u32; 3]| {
            let corner = |vertex: u32| self.positions.get(vertex as usize).map(|at| at.as_dvec3());
            let [a, b, c] = vertices.map(corner);
            let corners = [a?, b?, c?];
            let weights = nearest_weights(to.as_dvec3(), corners);
            let at = corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2];
            let point = MeshPoint { vertices, weights: weights.map(|weight| weight as f32) };
            Some((at.distance_squared(to.as_dvec3()), point))
        };
        let nearest =
            triangles.filter_map(of_triangle).min_by(|one, other| one.0.total_cmp(&other.0));
        nearest.map(|(_, point)| point)
    }

    /// Where a point lies, m; none if the mesh lacks one of its vertices.
    #[must_use]
    pub fn place(&self, point: &MeshPoint) -> Option<Vec3> {
        let corner = |vertex: u32| self.positions.get(vertex as usize).copied();
        let corners = point.vertices.into_iter().zip(point.weights);
        corners.map(|(vertex, weight)| Some(corner(vertex)? * weight)).sum()
    }

    /// Checks that the points lie on triangles.
    pub(super) fn check_points(&self) -> Result<(), FabricError> {
        let vertices = self.positions.len();
        for (MeshPoint { vertices: corners, weights }, _) in &self.points {
            if let Some(&vertex) = corners.iter().find(|&&vertex| vertex as usize >= vertices) {
                return Err(FabricError::PointOutOfRange { vertex, vertices });
            }
            let is_weight = |weight: &f32| (0.0..=1.0).contains(weight);
            let is_sum = (weights.iter().sum::<f32>() - 1.0).abs() < OFF;
            if !weights.iter().all(is_weight) || !is_sum {
                return Err(FabricError::PointWeights { vertices: *corners, weights: *weights });
            }
        }
        self.points_on_triangles().map(|_| ())
    }

    /// The points with their triangles.
    ///
    /// # Errors
    ///
    /// [`FabricError::PointOffMesh`].
    pub(super) fn points_on_triangles(&self) -> Result<Vec<PointOn>, FabricError> {
        if self.points.is_empty() {
            return Ok(Vec::new());
        }
        let triangles = self.indices.as_chunks::<3>().0;
        let numbers: HashMap<[u32; 3], u32> =
            triangles.iter().map(|&corners| sorted(corners)).zip(0..).collect();
        let with = |vertex: u32| {
            (0..).zip(triangles).find(|(_, it)| it.contains(&vertex)).map(|(number, _)| number)
        };
        let on_triangle = |&(point, is_pinned): &(MeshPoint, bool)| {
            let MeshPoint { vertices, weights } = point;
            let between = || numbers.get(&sorted(vertices)).copied();
            let triangle = point.vertex().map_or_else(between, with);
            let triangle = triangle.ok_or(FabricError::PointOffMesh { vertices })?;
            let weight = |corner: u32| {
                let mut own = vertices.iter().zip(weights).filter(|(vertex, _)| **vertex == corner);
                f64::from(own.next().map_or(0.0, |(_, weight)| weight))
            };
            let weights = triangles[triangle as usize].map(weight);
            let sum: f64 = weights.iter().sum();
            Ok(PointOn { triangle, weights: weights.map(|weight| weight / sum), is_pinned })
        };
        self.points.iter().map(on_triangle).collect()
    }
}

fn sorted(mut corners: [u32; 3]) -> [u32; 3] {
    corners.sort_unstable();
    corners
}
