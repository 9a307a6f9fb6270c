//! The seams of a cloth in its lane.

use std::sync::Arc;

use glam::Vec3;

use crate::seams::link_place::LinkPlace;
use crate::seams::plan::{Seams, Sewn};
use crate::seams::stitch::Lacing;

/// The seams of a cloth in its lane.
#[derive(Clone, Debug)]
pub(crate) struct LaneSeams {
    pub seams: Arc<Seams>,
    /// The stitches that are closed in this tick.
    pub lacings: Vec<Lacing>,
    /// Where the targets of the links of lines are; empty until they are looked for.
    pub(super) places: Vec<LinkPlace>,
    pub(super) sewing: Sewing,
}

impl LaneSeams {
    pub fn new(seams: Arc<Seams>, lacings: Vec<Lacing>) -> Self {
        Self { seams, lacings, places: Vec::new(), sewing: Sewing::default() }
    }

    /// Whether any stitch is closed.
    pub fn are_closed(&self) -> bool {
        let count = self.seams.count();
        let has_any = |lacing: &Lacing| lacing.stitches.start < lacing.stitches.end.min(count);
        self.lacings.iter().any(has_any)
    }

    /// The particles of all closed stitches.
    pub fn closed_particles(&self) -> impl Iterator<Item = u32> {
        self.closed_stitches().flat_map(|stitch| self.particles_of(stitch))
    }

    /// The particles that closed stitches join, in both orders, ascending.
    pub fn joined_particles(&self) -> Vec<[u32; 2]> {
        let mut joined = Vec::new();
        for stitch in self.closed_stitches() {
            let mut onto = self.particles_of(stitch);
            let Some(first) = onto.next() else { continue };
            joined.extend(onto.flat_map(|other| [[first, other], [other, first]]));
        }
        joined.sort_unstable();
        joined
    }

    fn closed_stitches(&self) -> impl Iterator<Item = &Sewn> {
        let stitches = &self.seams.stitches;
        self.lacings.iter().flat_map(|lacing| {
            let end = lacing.stitches.end.min(stitches.len());
            &stitches[lacing.stitches.start.min(end)..end]
        })
    }

    fn particles_of(&self, stitch: &Sewn) -> impl Iterator<Item = u32> {
        stitch.ends.iter().map(|end| self.seams.particles[end.at as usize])
    }

    /// Forgets where the targets of links are: the cloth gets another layout.
    pub fn forget_places(&mut self) {
        self.places.clear();
    }
}

/// The particles and links of seams while they are solved.
#[derive(Clone, Debug, Default)]
pub(super) struct Sewing {
    /// Positions, m.
    pub at: Vec<Vec3>,
    /// Positions at the start of the substep, m.
    pub start: Vec<Vec3>,
    /// Inverse masses, 1/m².
    pub inverse_mass: Vec<f32>,
    /// The length of each link of lines under the tension found so far, m.
    pub target: Vec<f32>,
    /// Its compliance, 1/m².
    pub compliance: Vec<f32>,
    pub rows: Vec<Row>,
}

/// A link of a line in the elimination.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Row {
    /// From the seam into the cloth; zero for a link without length.
    pub direction: Vec3,
    /// Coupling with the tension of the link that is nearer to the seam, 1/m².
    pub coupling: f32,
    /// One over the diagonal, m².
    pub inverse: f32,
    /// The right side, m.
    pub right: f32,
}
