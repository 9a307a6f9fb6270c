//! Triangles joined in pairs at their common edges.

use std::collections::BTreeMap;

use glam::Vec3;

use super::Repairing;
use crate::fabric::topology::ascending;

/// Two triangles that are joined at an edge.
pub(super) struct Joint {
    /// Indices of the triangles.
    pub triangles: [usize; 2],
    /// The particles at the ends of the edge.
    pub ends: [u32; 2],
}

impl Repairing {
    /// Joins triangles at each edge; at edges of more than two, the pair that continues one another most straightly
    /// first.
    pub(super) fn join_triangles(&mut self) -> Vec<Joint> {
        let mut at_edges: BTreeMap<[u32; 2], Vec<usize>> = BTreeMap::new();
        for (index, corners) in self.triangles.iter().enumerate() {
            let [a, b, c] = self.particles(corners);
            for ends in [[a, b], [b, c], [c, a]] {
                at_edges.entry(ascending(ends)).or_default().push(index);
            }
        }
        let mut joints = Vec::new();
        for (ends, mut triangles) in at_edges {
            if triangles.len() > 2 {
                let (_, vertices) = self.across(triangles[0], ends);
                self.report.split_edges.push(vertices);
            }
            while let Some(pair) = self.straightest(&triangles, ends) {
                triangles.retain(|at| !pair.contains(at));
                joints.push(Joint { triangles: pair, ends });
            }
        }
        joints
    }

    /// Those two triangles at an edge that lie most on opposite sides of it.
    fn straightest(&self, triangles: &[usize], ends: [u32; 2]) -> Option<[usize; 2]> {
        let directions: Vec<Vec3> =
            triangles.iter().map(|&triangle| self.across(triangle, ends).0).collect();
        let pairs = (0..triangles.len()).flat_map(|one| (0..one).map(move |two| [two, one]));
        let cosine = |[one, two]: &[usize; 2]| directions[*one].dot(directions[*two]);
        let straightest = pairs.min_by(|one, two| cosine(one).total_cmp(&cosine(two)))?;
        Some(straightest.map(|at| triangles[at]))
    }

    /// The unit direction in a triangle's plane from one of its edges, at right angles to it, and the edge's vertices.
    fn across(&self, triangle: usize, ends: [u32; 2]) -> (Vec3, [u32; 2]) {
        let corners = &self.triangles[triangle];
        let particles = self.particles(corners);
        let opposite = (0..3).find(|&at| !ends.contains(&particles[at])).unwrap_or(0);
        let [tip, from, to] = [0, 1, 2].map(|turn| corners.vertices[(opposite + turn) % 3]);
        let [at_tip, at_from, at_to] = [tip, from, to].map(|at| self.positions[at as usize]);
        let along = (at_to - at_from).normalize_or_zero();
        let away = at_tip - at_from;
        let direction = (away - along * along.dot(away)).normalize_or_zero();
        (direction, ascending([from, to]))
    }
}
