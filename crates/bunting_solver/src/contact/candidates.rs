//! What of a cloth may touch a collider in a tick.

use glam::Vec3;

use crate::contact::triangles::TriangleCells;
use crate::fabric::Fabric;

/// Particles that a collider has pushed in a substep so far, and their displacements, m, in the cloth's frame.
pub(crate) type Pushed = Vec<(u32, Vec3)>;

/// What of a cloth may touch a collider in a tick.
#[derive(Clone, Debug, Default)]
pub(crate) struct Candidates {
    /// Particles.
    pub particles: Vec<u32>,
    /// Particles that are corners of [`triangles`](Self::triangles).
    pub corners: Vec<u32>,
    /// Triangles that features of the shape may cut between the particles, as indices of corners.
    pub triangles: Vec<[u32; 3]>,
    /// Whether the particles are those of a set of colliders in lanes.
    pub is_in_lanes: bool,
    /// Whether the collider moves so far in a substep that it carries along what it hits.
    pub carries: bool,
    /// Whether contacts are solved at the end of a substep alone, where passes would disturb the cloth: around pins within the collider, since
    /// pushes that draw cloth off its pins are taken back (`strain_limit.rs`); beside triangles, which only the end moves; and before a shape
    /// that carries cloth along, since lines pull it back.
    pub wait_for_end: bool,
    /// Those of the particles that touched the collider when this was last computed in this tick; all of them before.
    pub touching: Vec<u32>,
    /// What the collider has pushed particles after the passes of this substep.
    pub pushed: Pushed,
    /// The collider's triangles near the cloth, if it consists of triangles. They are kept from tick to tick.
    pub cells: Option<TriangleCells>,
}

impl Candidates {
    pub fn is_empty(&self) -> bool {
        self.particles.is_empty() && self.triangles.is_empty()
    }

    pub fn clear(&mut self) {
        self.particles.clear();
        self.corners.clear();
        self.triangles.clear();
        self.is_in_lanes = false;
        self.carries = false;
        self.wait_for_end = false;
        self.touching.clear();
        self.pushed.clear();
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
