//! Textures of several pieces, whose warps run in different directions on the mesh, as artists pack them.
//!
//! Such a mesh is laid into the plane as if all of it continued the largest piece. Each cell of its grid then has the warp of the piece
//! that it lies in.

use glam::Vec2;

use super::on_chart::OnChart;
use super::warps::warps_of_triangles;
use crate::fabric::laid_yarns::{Directions, Faces, Towards};
use crate::fabric::mesh::{RestMesh, Surface};

/// Least cosine of the angle between the warps on both sides of a seam with which pieces count as one: 14°. Smaller: meshes of pieces
/// that are turned against one another are laid with distortion.
const AGREE: f32 = 0.97;

/// The surface with the texture of its largest piece alone; none if the warps of all pieces agree where they meet.
pub(super) fn of_largest_piece(mesh: &RestMesh, surface: &Surface) -> Option<Surface> {
    let faces = Faces::new(&mesh.positions, &mesh.triangles, &surface.edges);
    let pieces = Pieces { faces: &faces, corner_uv: &surface.corner_uv };
    let of_triangles = pieces.of_triangles();
    if of_triangles.iter().all(|&piece| piece == 0) || pieces.agree() {
        return None;
    }
    let mut areas = vec![0.0; of_triangles.len()];
    for (&piece, area) in of_triangles.iter().zip(&surface.triangle_areas) {
        areas[piece as usize] += area;
    }
    let largest = (0..).zip(&areas).max_by(|a, b| a.1.total_cmp(b.1)).map(|(piece, _)| piece)?;
    let mut one = surface.clone();
    let others = one.corner_uv.iter_mut().zip(&of_triangles).filter(|(_, at)| **at != largest);
    others.for_each(|(uv, _)| *uv = [Vec2::ZERO; 3]);
    Some(one)
}

/// cos² of the angle between the rows and the warp in each cell: that of the triangle at its centre.
pub(super) fn warps_of_cells(on: &OnChart, surface: &Surface, in_cells: &[Vec<u32>]) -> Vec<f32> {
    let OnChart { mesh, chart, grid, .. } = on;
    let places = |corners: [u32; 3]| corners.map(|corner| chart.positions[corner as usize]);
    let triangles = chart.of_mesh.iter().zip(&chart.triangles);
    let triangles = triangles.map(|(&of_mesh, &corners)| (of_mesh, places(corners)));
    let of_triangles = warps_of_triangles(mesh, surface, triangles);
    let spacing = Vec2::from(grid.spacing());
    let cells = (0..).zip(in_cells);
    let of_cell = |(cell, triangles): (u32, &Vec<u32>)| {
        let place =
            Vec2::new((cell % (grid.columns - 1)) as f32, (cell / (grid.columns - 1)) as f32);
        let centre = (place + 0.5) * spacing;
        let off = |triangle: &u32| outside(places(chart.triangles[*triangle as usize]), centre);
        let nearest = triangles.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
        nearest.map_or(1.0, |&triangle| of_triangles[triangle as usize])
    };
    cells.map(of_cell).collect()
}

/// How far a place lies outside of a triangle, in units of the triangle's size; not above zero within it.
fn outside([a, b, c]: [Vec2; 3], at: Vec2) -> f32 {
    let area = (b - a).perp_dot(c - a);
    let part = |from: Vec2, to: Vec2| (from - at).perp_dot(to - at) / area;
    -part(a, b).min(part(b, c)).min(part(c, a))
}

/// The pieces of a texture.
struct Pieces<'a> {
    faces: &'a Faces<'a>,
    corner_uv: &'a [[Vec2; 3]],
}

impl Pieces<'_> {
    /// The first triangle of the piece of each triangle.
    fn of_triangles(&self) -> Vec<u32> {
        let mut pieces: Vec<Option<u32>> = vec![None; self.faces.count()];
        let mut next = Vec::new();
        for first in 0..self.faces.count() as u32 {
            next.push(first);
            while let Some(triangle) = next.pop() {
                let piece = &mut pieces[triangle as usize];
                if piece.is_none() {
                    *piece = Some(first);
                    let neighbours = (0..3).filter_map(|side| self.across(triangle, side));
                    next.extend(neighbours.filter(|(_, is_seam)| !is_seam).map(|(other, _)| other));
                }
            }
        }
        pieces.into_iter().flatten().collect()
    }

    /// The triangle across a side of one, and whether a seam of the texture lies between; none at the border.
    fn across(&self, triangle: u32, side: usize) -> Option<(u32, bool)> {
        let other = self.faces.across(triangle, side)?;
        let particles = self.faces.particles(triangle);
        let ends = [particles[side], particles[(side + 1) % 3]];
        let is_seam = ends.iter().any(|&end| self.uv(triangle, end) != self.uv(other, end));
        Some((other, is_seam))
    }

    /// The place in the texture of a triangle's corner at a particle.
    fn uv(&self, triangle: u32, particle: u32) -> Option<Vec2> {
        let corner = self.faces.particles(triangle).iter().position(|&at| at == particle)?;
        Some(self.corner_uv[triangle as usize][corner])
    }

    /// Whether the warps on both sides of all seams agree.
    fn agree(&self) -> bool {
        let directions = Directions::of(self.faces, self.corner_uv);
        (0..self.faces.count() as u32).all(|triangle| {
            let corners = self.faces.corners(triangle);
            (0..3).all(|side| {
                let Some((other, true)) = self.across(triangle, side) else { return true };
                let seam = (corners[(side + 1) % 3] - corners[side]).normalize_or_zero();
                // Along the seam and at right angles to it, as if both triangles lay in a plane.
                let [one, other] = [triangle, other].map(|at| {
                    let warp = directions.of_triangle(at, Towards::Warp);
                    let across = self.faces.normals[at as usize].cross(seam);
                    Vec2::new(warp.dot(seam), warp.dot(across))
                });
                one.dot(other).abs() > AGREE
            })
        })
    }
}
