//! The drawn surface of a mesh whose triangles are larger than the cells of the simulation: its folds are those of the simulated surface.

use glam::{Vec3, Vec3A};
use parry3d::query::PointQueryWithLocation;
use parry3d::shape::TriMesh;

use super::mesh::Points;
use super::stencils::Stencils;
use super::{Scheme, Subdivision};
use crate::fabric::Fabric;

/// Halvings of the simulated surface, on whose triangles drawn vertices lie. Fewer: the cells of the simulation show as facets.
const SMOOTHINGS: u32 = 1;

impl Subdivision {
    /// Halves the edges of a mesh `steps` times, as [`of_mesh`](Self::of_mesh) does, but in the planes of its triangles, and puts
    /// the vertices that it adds onto the smooth surface through a fabric's particles: where the mesh is coarser than the fabric, a
    /// surface through its own vertices would hide the folds. What is [evaluated](Self::evaluate) are the positions of the places,
    /// and behind them those of the particles.
    ///
    /// # Panics
    ///
    /// If there is no such vertex or place.
    #[must_use]
    pub fn on_surface(
        fabric: &Fabric,
        places: &[Vec3],
        place_of: &[u32],
        indices: &[u32],
        steps: u32,
    ) -> Self {
        let flat = Self::halved(places, place_of, indices, steps, Points::flat);
        let Scheme::Mesh { points, triangles, point_of_vertex } = flat.scheme else {
            unreachable!("a mesh is no grid")
        };
        let at_rest = positions(&points, places);
        let mut smooth = Points::new(fabric.rest_positions(), fabric.triangles().to_vec());
        (0..SMOOTHINGS).for_each(|_| smooth.subdivide());
        let surface = positions(&smooth.stencils, fabric.rest_positions());
        let mesh = TriMesh::new(surface, smooth.triangles.clone());
        let first = places.len() as u32;
        let mut on_surface = Stencils::identity(first);
        for (point, at) in at_rest.iter().enumerate().skip(places.len()) {
            let found = mesh.as_ref().ok().and_then(|mesh| {
                let (_, (triangle, location)) =
                    mesh.project_local_point_and_get_location(*at, false);
                Some((triangle, location.barycentric_coordinates()?))
            });
            let Some((triangle, weights)) = found else {
                // A surface that cannot be searched: the vertex stays between those beside it.
                on_surface.push(points.row(point as u32).iter().copied());
                continue;
            };
            let corners = smooth.triangles[triangle as usize].into_iter().zip(weights);
            let row = smooth.stencils.expand(&corners.collect::<Vec<_>>());
            on_surface.push(row.into_iter().map(|(particle, weight)| (first + particle, weight)));
        }
        Self { scheme: Scheme::Mesh { points: on_surface, triangles, point_of_vertex }, ..flat }
    }
}

/// The sums of positions by stencils, m.
fn positions(stencils: &Stencils, of: &[Vec3]) -> Vec<Vec3> {
    let of: Vec<Vec3A> = of.iter().map(|at| Vec3A::from(*at)).collect();
    let mut sums = Vec::new();
    stencils.apply(&of, &mut sums);
    sums.into_iter().map(Vec3::from).collect()
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use crate::fabric::{FabricBuilder, Resampled, Resolution};
    use crate::subdivision::{Subdivision, SubdivisionBuffers};

    /// Height of the folds, m. The surface through particles is lower by 4 % of it: a fold has six cells.
    const HEIGHT: f32 = 0.05;

    /// A sheet of two triangles whose particles lie in folds: so do the vertices that are drawn.
    #[test]
    fn what_is_drawn_of_a_coarse_mesh_has_the_folds_of_its_particles() {
        let corners =
            [[0.0, 0.0], [1.0, 0.0], [0.0, -1.0], [1.0, -1.0]].map(|[x, y]| Vec3::new(x, y, 0.0));
        let indices = vec![0, 2, 1, 1, 2, 3];
        let builder = FabricBuilder::new(corners.to_vec(), indices.clone());
        let Resampled { fabric, carried, .. } =
            builder.resampled(Resolution::CellSize(0.05)).expect("a sheet");
        let rest = fabric.rest_positions();
        let places = carried.places(rest);
        let drawn =
            Subdivision::on_surface(&fabric, &places, carried.place_of_vertex(), &indices, 4);
        let fold = |at: Vec3| at.with_z(HEIGHT * libm::sinf(20.0 * at.x));
        let folded: Vec<Vec3> = rest.iter().map(|at| fold(*at)).collect();
        let values: Vec<Vec3> = carried.places(&folded).into_iter().chain(folded).collect();
        let count = drawn.attributes().rows().len();
        let (mut at, mut normals) = (vec![[0.0; 3]; count], vec![[0.0; 3]; count]);
        drawn.evaluate(&values, &mut SubdivisionBuffers::default(), &mut at, &mut normals);
        assert_eq!(count, 17 * 17);
        for (at, row) in at.into_iter().map(Vec3::from).zip(drawn.attributes().rows()) {
            let flat: Vec3 = row.iter().map(|(vertex, by)| corners[*vertex as usize] * *by).sum();
            assert!(at.distance(fold(flat)) < 0.08 * HEIGHT, "{at} for {}", fold(flat));
        }
    }
}
