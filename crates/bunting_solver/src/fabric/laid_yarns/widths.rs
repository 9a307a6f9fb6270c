//! The distances at which yarns are laid, and the width of cloth that each of them stands for.

use super::Node;
use super::lay::Line;
use crate::fabric::links::LinkFamily;
use crate::fabric::mesh::{RestMesh, Surface};

/// Rounds in which lengths and areas are summed over the triangles around each particle. Fewer: links that happen to lie
/// where few others do are stiffer. More: a graded mesh has its mean's stiffness.
const ROUNDS: usize = 2;

/// Distance of yarns in each triangle, m: the mean distance of the particles around.
pub(super) fn spacing(mesh: &RestMesh, surface: &Surface) -> Vec<f32> {
    let one = vec![1.0; mesh.triangles.len()];
    let areas = summed(mesh, &surface.triangle_areas);
    let counts = summed(mesh, &one);
    let around = |particle: &u32| areas[*particle as usize] / counts[*particle as usize];
    let of_triangle = |corners: &[u32; 3]| {
        // Two triangles have the area of a particle.
        (2.0 * corners.iter().map(around).sum::<f32>() / 3.0).sqrt()
    };
    mesh.triangles.iter().map(of_triangle).collect()
}

/// Width of cloth per yarn of each family about each particle.
pub(super) struct Widths {
    of_families: [Vec<f32>; 3],
}

impl Widths {
    pub fn of(mesh: &RestMesh, surface: &Surface, lines: &[Line]) -> Self {
        let areas = summed(mesh, &surface.triangle_areas);
        let of_families =
            [LinkFamily::Warp, LinkFamily::Weft, LinkFamily::Diagonal].map(|family| {
                let mut lengths = vec![0.0; mesh.triangles.len()];
                for piece in lines.iter().flat_map(|line| &line.pieces) {
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
    let mut of_triangles = of_triangles.to_vec();
    for round in 0.. {
        let mut of_particles = vec![0.0; mesh.positions.len()];
        for (corners, value) in mesh.triangles.iter().zip(&of_triangles) {
            for &corner in corners {
                of_particles[corner as usize] += value;
            }
        }
        if round + 1 == ROUNDS {
            return of_particles;
        }
        for (corners, value) in mesh.triangles.iter().zip(&mut of_triangles) {
            *value = corners.iter().map(|&corner| of_particles[corner as usize]).sum();
        }
    }
    Vec::new()
}
