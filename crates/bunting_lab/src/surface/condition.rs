//! The condition of a surface over some moments, in a few figures.

use glam::{DVec3, Vec3};

use super::Surface;
use crate::{simulation::in_double, stats::worse};

/// Parts of their area at rest below which triangles are counted.
const COMPRESSED: [f64; 2] = [0.8, 0.95];

/// Figures of a surface over the moments at which it was observed.
#[derive(Clone, Copy, Debug)]
pub struct Condition {
    /// Triangles with less than .8 and than .95 of their area at rest, %.
    pub compressed: [f64; 2],
    /// Greatest [`Surface::roughness`], °.
    pub roughness: f64,
}

/// A surface with all that was seen of it.
#[derive(Clone, Debug)]
pub struct Observed {
    surface: Surface,
    areas: Vec<f64>,
    roughness: f64,
}

impl Observed {
    /// A surface that has not been observed yet.
    #[must_use]
    pub fn new(surface: Surface) -> Self {
        Self { surface, areas: Vec::new(), roughness: 0.0 }
    }

    /// Observes the surface with its vertices at positions, m.
    pub fn observe(&mut self, positions: &[Vec3]) {
        let positions: Vec<DVec3> = in_double(positions);
        self.areas.extend(self.surface.areas(&positions));
        self.roughness = worse(self.roughness, self.surface.roughness(&positions));
    }

    /// The figures of all that was observed.
    #[must_use]
    pub fn condition(self) -> Condition {
        // What is no number is below.
        let share = |part: f64| {
            let above = self.areas.iter().filter(|area| **area >= part).count();
            100.0 * (self.areas.len() - above) as f64 / self.areas.len() as f64
        };
        Condition { compressed: COMPRESSED.map(share), roughness: self.roughness }
    }
}
