//! What of a cloth may touch a collider in a tick.

use crate::fabric::Fabric;

/// What of a cloth may touch a collider in a tick.
#[derive(Clone, Debug, Default)]
pub(crate) struct Candidates {
    /// Particles.
    pub particles: Vec<u32>,
    /// Particles that are corners of [`triangles`](Self::triangles).
    pub corners: Vec<u32>,
    /// Triangles that features of the shape may cut between the particles, as indices of corners.
    pub triangles: Vec<[u32; 3]>,
}

impl Candidates {
    pub fn is_empty(&self) -> bool {
        self.particles.is_empty() && self.triangles.is_empty()
    }

    pub fn clear(&mut self) {
        self.particles.clear();
        self.corners.clear();
        self.triangles.clear();
    }

    /// Adds the selected triangles, given as their particles, unless all of these are pinned.
    pub fn gather_triangles(&mut self, fabric: &Fabric, is_near: impl Fn([usize; 3]) -> bool) {
        /// No index of a corner yet.
        const NONE: u32 = u32::MAX;
        let mut index_of = vec![NONE; fabric.particle_count()];
        for triangle in fabric.triangles() {
            let particles = triangle.map(|particle| particle as usize);
            if !is_near(particles) || particles.iter().all(|&at| fabric.is_pinned(at)) {
                continue;
            }
            self.triangles.push(particles.map(|particle| {
                if index_of[particle] == NONE {
                    index_of[particle] = self.corners.len() as u32;
                    self.corners.push(particle as u32);
                }
                index_of[particle]
            }));
        }
    }
}
