//! A triangle mesh on which nodes are placed.

use glam::{DVec3, Vec2, Vec3};

use super::place::Place;
use crate::fabric::directions::Directions;
use crate::fabric::faces::Faces;
use crate::fabric::interpolation::{Interpolation, Term};
use crate::fabric::mesh::{RestMesh, Surface};
use crate::fabric::topology::Edge;

/// A mesh with what nodes on it are found from.
pub(in crate::fabric) struct Source<'a> {
    pub(super) mesh: &'a RestMesh,
    pub edges: &'a [Edge],
    pub(super) faces: Faces<'a>,
    corner_uv: &'a [[Vec2; 3]],
    pub directions: Directions,
    pub(super) positions: Vec<DVec3>,
    /// Unit normals of the vertices.
    pub(super) normals: Vec<DVec3>,
    /// Vertices at points, which are nodes.
    pub(super) points: &'a [u32],
    /// m².
    pub(super) area: f64,
}

impl<'a> Source<'a> {
    pub fn new(mesh: &'a RestMesh, surface: &'a Surface, points: &'a [u32]) -> Self {
        let faces = Faces::new(&mesh.positions, &mesh.triangles, &surface.edges);
        let normals = mesh.normals_at(&mesh.positions);
        Self {
            mesh,
            points,
            edges: &surface.edges,
            corner_uv: &surface.corner_uv,
            directions: Directions::of(&faces, &surface.corner_uv),
            faces,
            positions: mesh.positions.iter().map(|at| at.as_dvec3()).collect(),
            normals: normals.iter().map(|at| at.as_dvec3().normalize_or(DVec3::Z)).collect(),
            area: surface.triangle_areas.iter().map(|area| f64::from(*area)).sum(),
        }
    }

    /// The size of the cells of a lattice with a number of nodes, m. By Pick's theorem N = A/h² + L/2h with the length L of
    /// the border.
    pub fn cell_size(&self, count: f64) -> f64 {
        let border = self.edges.iter().filter(|edge| edge.other_side.is_none());
        let length = |edge: &Edge| {
            let [one, other] = edge.ends.map(|at| self.positions[at as usize]);
            one.distance(other)
        };
        let quarter = 0.25 * border.map(length).sum::<f64>();
        (quarter + (quarter * quarter + count * self.area).sqrt()) / count
    }

    /// About how many nodes a lattice with cells of a size, m, has.
    pub fn node_count(&self, size: f64) -> f64 {
        self.area / (size * size)
    }

    /// The place of a vertex, in no triangle of its own.
    pub(super) fn at_vertex(&self, vertex: u32) -> Place {
        let [at, normal] = [&self.positions, &self.normals].map(|of| of[vertex as usize]);
        Place { triangle: 0, weights: [0.0; 3], at, normal, vertex: Some(vertex) }
    }

    /// Texture coordinates of a place.
    pub(super) fn uv(&self, place: &Place) -> Vec2 {
        match place.vertex {
            Some(vertex) => self.mesh.uv[vertex as usize],
            None => {
                let corners = self.corner_uv[place.triangle as usize].into_iter();
                corners.zip(place.weights).map(|(uv, weight)| uv * weight as f32).sum()
            }
        }
    }

    /// The particles around a place with their weights.
    pub(super) fn terms(&self, place: &Place) -> Vec<Term> {
        if let Some(from) = place.vertex {
            return vec![Term { from, weight: 1.0 }];
        }
        let corners = self.faces.particles(place.triangle).into_iter().zip(place.weights);
        corners.map(|(from, weight)| Term { from, weight: weight as f32 }).collect()
    }

    /// Weight of free particles at a place.
    pub(super) fn free_part(&self, place: &Place) -> f64 {
        let terms = self.terms(place).into_iter();
        let free = terms.filter(|term| !self.mesh.is_pinned(term.from));
        free.map(|term| f64::from(term.weight)).sum()
    }

    /// Positions interpolated from those of the vertices, m.
    pub(super) fn interpolated(&self, rows: &Interpolation) -> Vec<Vec3> {
        let position = |row: &[Term]| -> Vec3 {
            row.iter().map(|term| self.mesh.positions[term.from as usize] * term.weight).sum()
        };
        rows.rows().map(position).collect()
    }
}
