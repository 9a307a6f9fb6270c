//! The vertices of a mesh on the surface between the particles that are simulated in its place.

use glam::Vec3;

use super::background::{Height, Interpolation};
use crate::step::follow;

/// The places of a mesh's vertices on the surface between particles.
#[derive(Clone, Debug)]
pub struct Carried {
    /// Of each place the particles that it is interpolated from.
    pub(super) rows: Interpolation,
    /// How far places lie above the surface between particles.
    pub(super) heights: Vec<Height>,
    /// The place of each vertex: those of a seam share one.
    pub(super) place_of_vertex: Vec<u32>,
}

impl Carried {
    /// Positions of all vertices, m, given those of the particles, m.
    #[must_use]
    pub fn positions(&self, particles: &[Vec3]) -> Vec<Vec3> {
        let mut places = vec![Vec3::ZERO; self.rows.len()];
        follow::follow(&self.rows, &self.heights, particles, &mut places);
        self.place_of_vertex.iter().map(|&place| places[place as usize]).collect()
    }
}
