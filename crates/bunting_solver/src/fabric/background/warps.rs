//! The angles between the rows of a chart whose lines are curved and the warp.

use glam::{Vec2, Vec3};

use super::gradient_fit::gradient;
use crate::fabric::laid_yarns::{Directions, Faces, Towards};
use crate::fabric::mesh::{RestMesh, Surface};

/// Greatest difference of cos² of the angle between rows and warp in a triangle from the mean around its corners. Larger:
/// cells at seams of pieces with different warps are sheared as if cut on the bias.
const UNLIKE_WARPS: f32 = 0.2;

/// cos² of the angle between the rows and the warp at each particle; given the places of the
/// corners of its triangles; none if it differs much between neighbours.
pub(super) fn warps_of_rows(
    mesh: &RestMesh,
    surface: &Surface,
    positions: &[Vec2],
    triangles: &[[u32; 3]],
) -> Option<Vec<f32>> {
    let faces = Faces::new(&mesh.positions, &mesh.triangles, &surface.edges);
    let directions = Directions::of(&faces, &surface.corner_uv);
    let mut sums = vec![[0.0; 2]; mesh.positions.len()];
    let mut of_triangles = Vec::new();
    for (triangle, corners) in (0_u32..).zip(&mesh.triangles) {
        let places = triangles[triangle as usize];
        let downwards = places.map(|place| f64::from(positions[place as usize].y));
        let across_rows = gradient(mesh.positions_of(*corners).map(Vec3::as_dvec3), downwards);
        let warp = directions.of_triangle(triangle, Towards::Warp).as_dvec3();
        let cos2 = (1.0 - warp.dot(across_rows).powi(2) / across_rows.length_squared()) as f32;
        of_triangles.push(cos2);
        let area = surface.triangle_areas[triangle as usize];
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
