//! The vertices of a mesh on the surface between the particles that are simulated in its place.

use glam::Vec3;

use super::interpolation::{Height, Interpolation, Term};
use super::normals::vertex_normals;

/// The places of a mesh's vertices on the surface between the particles of a [`Resampled`](crate::Resampled) fabric. Vertices at
/// the same position, as along the seams of a texture, have one place.
#[derive(Clone, Debug)]
pub struct Carried {
    /// Of each place the particles that it is interpolated from.
    pub(super) rows: Interpolation,
    /// How far places lie above the surface between particles.
    pub(super) heights: Vec<Height>,
    /// How far pinned places lie from the straight line between the pinned particles beside them, m: constant in the cloth's frame.
    pub(super) held: Vec<(u32, Vec3)>,
    /// The place of each vertex.
    pub(super) place_of_vertex: Vec<u32>,
    /// The mesh's triangles as places.
    pub(super) triangles: Vec<[u32; 3]>,
}

impl Carried {
    /// Positions of all places, m, given those of the particles, m. At rest they are the positions of the mesh.
    ///
    /// # Panics
    ///
    /// If the positions are those of another fabric with fewer particles.
    #[must_use]
    pub fn places(&self, particles: &[Vec3]) -> Vec<Vec3> {
        let on_surface = |row: &[Term]| interpolated(row, particles);
        let mut places: Vec<Vec3> = self.rows.rows().map(on_surface).collect();
        for height in &self.heights {
            places[height.place as usize] += height.raise(particles);
        }
        for (place, offset) in &self.held {
            places[*place as usize] += *offset;
        }
        places
    }

    /// Unit normals at all places, given their positions, m: the area-weighted means of the normals of their triangles, on the front
    /// side. Zero if these have no area.
    #[must_use]
    pub fn normals(&self, places: &[Vec3]) -> Vec<Vec3> {
        let corners = |corners: &[u32; 3]| corners.map(|corner| places[corner as usize]);
        let triangles = self.triangles.iter();
        vertex_normals(places.len(), triangles.map(|triangle| (corners(triangle), *triangle)))
    }

    /// The place of each vertex of the mesh.
    #[must_use]
    pub fn place_of_vertex(&self) -> &[u32] {
        &self.place_of_vertex
    }

    /// Position of a vertex, m, given those of the particles, m.
    ///
    /// # Panics
    ///
    /// If there is no such vertex; as [`places`](Self::places).
    #[must_use]
    pub fn position(&self, vertex: usize, particles: &[Vec3]) -> Vec3 {
        let place = self.place_of_vertex[vertex];
        let above = self.heights.binary_search_by_key(&place, |it| it.place);
        let above = above.map_or(Vec3::ZERO, |at| self.heights[at].raise(particles));
        let held = self.held.binary_search_by_key(&place, |it| it.0);
        let aside = held.map_or(Vec3::ZERO, |at| self.held[at].1);
        interpolated(self.rows.row(place as usize), particles) + above + aside
    }

    /// Positions of all vertices, m, given those of the particles, m.
    ///
    /// # Panics
    ///
    /// As [`places`](Self::places).
    #[must_use]
    pub fn positions(&self, particles: &[Vec3]) -> Vec<Vec3> {
        let places = self.places(particles);
        self.place_of_vertex.iter().map(|&place| places[place as usize]).collect()
    }
}

/// A position on the surface between particles, m.
fn interpolated(row: &[Term], particles: &[Vec3]) -> Vec3 {
    row.iter().map(|term| particles[term.from as usize] * term.weight).sum()
}
