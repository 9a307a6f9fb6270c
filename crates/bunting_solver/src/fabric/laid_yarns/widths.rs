//! The distances at which yarns are laid, and the width of cloth that each of them stands for.

use glam::Vec3;

use super::Node;
use super::faces::Faces;
use super::lay::Line;
use crate::fabric::links::LinkFamily;
use crate::fabric::mesh::{RestMesh, Surface};

/// Distance of lines, in mean widths of triangles at right angles to them. Smaller: more links, whose families work
/// against one another. Larger: particles between lines are held by few; with 1, one of three cylinders sank 9 % too
/// far.
const SPACING: f32 = 0.9;

/// Least distance of lines, in square roots of the areas of triangles. Smaller: a mesh of slivers has as many lines as
/// slivers, and takes long to build. Larger: long cells have fewer lines than rows.
const LEAST_SPACING: f32 = 0.35;

/// Rounds in which lengths and areas are summed over the triangles around each particle. Fewer: links that happen to
/// lie where few others do are stiffer. More: a graded mesh has its mean's stiffness.
const ROUNDS: usize = 2;

/// The distances of lines in one direction, and of their nodes, in each triangle.
///
/// Lines are as far apart as triangles are wide at right angles to them, in the mean, so that a mesh of long cells gets
/// as many of them as it has rows or columns.
pub(super) struct Spacing {
    /// Distance of lines, m.
    pub of_lines: Vec<f32>,
    /// Mean length of a line's pieces, m.
    pub of_crossings: Vec<f32>,
}

impl Spacing {
    pub fn of(
        mesh: &RestMesh,
        surface: &Surface,
        faces: &Faces,
        direction: impl Fn(u32) -> Vec3,
    ) -> Self {
        let width = |triangle: u32| {
            let across = faces.normals[triangle as usize].cross(direction(triangle));
            let places = faces.corners(triangle).map(|corner| corner.dot(across));
            let (low, high) = (f32::INFINITY, f32::NEG_INFINITY);
            let low = places.into_iter().fold(low, f32::min);
            places.into_iter().fold(high, f32::max) - low
        };
        let widths: Vec<f32> = (0..faces.count() as u32).map(width).collect();
        let ones = vec![1.0; widths.len()];
        let [counts, widths, areas] =
            [&ones, &widths, &surface.triangle_areas].map(|values| summed(mesh, values));
        let mean = |sums: &[f32], corners: &[u32; 3]| {
            let around = |&corner: &u32| sums[corner as usize] / counts[corner as usize];
            corners.iter().map(around).sum::<f32>() / 3.0
        };
        let widths: Vec<f32> = mesh.triangles.iter().map(|at| mean(&widths, at)).collect();
        let areas: Vec<f32> = mesh.triangles.iter().map(|at| mean(&areas, at)).collect();
        let both = || widths.iter().zip(&areas);
        let of_lines =
            both().map(|(width, area)| (SPACING * width).max(LEAST_SPACING * area.sqrt()));
        let of_crossings = both().map(|(width, area)| area / width);
        Self { of_lines: of_lines.collect(), of_crossings: of_crossings.collect() }
    }
}

/// Width of cloth per yarn of each family about each particle.
pub(super) struct Widths {
    of_families: [Vec<f32>; 3],
}

impl Widths {
    pub fn of<'a>(
        mesh: &RestMesh,
        surface: &Surface,
        lines: impl Iterator<Item = &'a Line> + Clone,
    ) -> Self {
        let areas = summed(mesh, &surface.triangle_areas);
        let of_families =
            [LinkFamily::Warp, LinkFamily::Weft, LinkFamily::Diagonal].map(|family| {
                let mut lengths = vec![0.0; mesh.triangles.len()];
                for piece in lines.clone().flat_map(|line| &line.pieces) {
                    if piece.family == family {
                        // Diagonals run in two directions.
                        let directions = if family == LinkFamily::Diagonal { 2.0 } else { 1.0 };
                        lengths[piece.triangle as usize] += piece.length / directions;
                    }
                }
                let lengths = summed(mesh, &lengths);
                areas.iter().zip(lengths).map(|(area, length)| area / length).collect()
            });
        Self { of_families }
    }

    /// The width at a node, m.
    pub fn at(&self, node: &Node, family: LinkFamily) -> f32 {
        let widths = &self.of_families[family as usize];
        let [a, b] = node.particles.map(|particle| widths[particle as usize]);
        a * node.parts[0] + b * node.parts[1]
    }
}

/// For each particle the sum of a value of triangles over those around it, in some rounds.
fn summed(mesh: &RestMesh, of_triangles: &[f32]) -> Vec<f32> {
    let mut of_particles = summed_once(mesh, of_triangles);
    for _ in 1..ROUNDS {
        let of_corners =
            |corners: &[u32; 3]| corners.iter().map(|&corner| of_particles[corner as usize]).sum();
        let of_triangles: Vec<f32> = mesh.triangles.iter().map(of_corners).collect();
        of_particles = summed_once(mesh, &of_triangles);
    }
    of_particles
}

/// For each particle the sum of a value of triangles over those around it.
fn summed_once(mesh: &RestMesh, of_triangles: &[f32]) -> Vec<f32> {
    let mut of_particles = vec![0.0; mesh.positions.len()];
    for (corners, value) in mesh.triangles.iter().zip(of_triangles) {
        for &corner in corners {
            of_particles[corner as usize] += value;
        }
    }
    of_particles
}
