//! The angles between the rows of a chart whose lines are curved and the warp.

use glam::{Vec2, Vec3};

use super::gradient_fit::gradient;
use crate::fabric::laid_yarns::{Directions, Faces, Towards};
use crate::fabric::mesh::{RestMesh, Surface};

/// Greatest difference of cos² of the angle between rows and warp in a triangle from the mean around its corners. Larger:
/// cells at seams of pieces with different warps are sheared as if cut on the bias.
const UNLIKE_WARPS: f32 = 0.2;

/// cos² of the angle between the rows and the warp at each particle, given the places of the corners of its triangles; none if it
/// differs much between neighbours.
pub(super) fn warps_of_rows(
    mesh: &RestMesh,
    surface: &Surface,
    positions: &[Vec2],
    triangles: &[[u32; 3]],
) -> Option<Vec<f32>> {
    let places = triangles.iter().map(|places| places.map(|place| positions[place as usize]));
    let of_triangles = warps_of_triangles(mesh, surface, (0..).zip(places));
    let mut sums = vec![[0.0; 2]; mesh.positions.len()];
    let corners = mesh.triangles.iter().zip(&of_triangles).zip(&surface.triangle_areas);
    for ((corners, cos2), area) in corners {
        for &corner in corners {
            let [sum, whole] = &mut sums[corner as usize];
            *sum += area * cos2;
            *whole += area;
        }
    }
    let warps: Vec<f32> = sums.iter().map(|[sum, whole]| sum / whole).collect();
    let is_alike = |(corners, of_triangle): (&[u32; 3], &f32)| {
        corners.iter().all(|&corner| (warps[corner as usize] - of_triangle).abs() < UNLIKE_WARPS)
    };
    mesh.triangles.iter().zip(&of_triangles).all(is_alike).then_some(warps)
}

/// cos² of the angle between the rows and the warp in triangles of a mesh, given their numbers and the places of their corners.
pub(super) fn warps_of_triangles(
    mesh: &RestMesh,
    surface: &Surface,
    triangles: impl Iterator<Item = (u32, [Vec2; 3])>,
) -> Vec<f32> {
    let faces = Faces::new(&mesh.positions, &mesh.triangles, &surface.edges);
    let directions = Directions::of(&faces, &surface.corner_uv);
    let cos2 = |(triangle, places): (u32, [Vec2; 3])| {
        let downwards = places.map(|place| f64::from(place.y));
        let across_rows = gradient(faces.corners(triangle).map(Vec3::as_dvec3), downwards);
        let warp = directions.of_triangle(triangle, Towards::Warp).as_dvec3();
        (1.0 - warp.dot(across_rows).powi(2) / across_rows.length_squared()) as f32
    };
    triangles.map(cos2).collect()
}
