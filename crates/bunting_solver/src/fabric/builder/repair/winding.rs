//! One winding for all triangles that are joined.

use std::collections::VecDeque;

use super::adjacency::Joint;
use super::{Corners, Repairing};
use crate::fabric::error::FabricError;

impl Repairing {
    /// Turns triangles over so that joined triangles run along their edge in opposite directions. Of each connected
    /// piece the part with less area is turned.
    ///
    /// # Errors
    ///
    /// A piece is one-sided.
    pub(super) fn make_winding_consistent(&mut self, joints: &[Joint]) -> Result<(), FabricError> {
        let mut neighbours = vec![Vec::new(); self.triangles.len()];
        for joint in joints {
            let [one, two] = joint.triangles;
            let is_turned = self.runs_forwards(one, joint) == self.runs_forwards(two, joint);
            neighbours[one].push((two, is_turned, joint.ends));
            neighbours[two].push((one, is_turned, joint.ends));
        }
        let mut turned: Vec<Option<bool>> = vec![None; self.triangles.len()];
        for first in 0..self.triangles.len() {
            if turned[first].is_some() {
                continue;
            }
            turned[first] = Some(false);
            let mut piece = vec![first];
            let mut next = VecDeque::from([first]);
            while let Some(at) = next.pop_front() {
                for &(neighbour, is_turned, ends) in &neighbours[at] {
                    let wanted = Some((turned[at] == Some(true)) != is_turned);
                    match turned[neighbour] {
                        None => {
                            turned[neighbour] = wanted;
                            piece.push(neighbour);
                            next.push_back(neighbour);
                        }
                        known if known != wanted => return Err(self.one_sided(at, ends)),
                        _ => {}
                    }
                }
            }
            self.turn_smaller_part(&piece, &turned);
        }
        self.report.turned.sort_unstable();
        Ok(())
    }

    /// Whether a triangle runs from the first end of a joint to the second.
    fn runs_forwards(&self, triangle: usize, joint: &Joint) -> bool {
        let [a, b, c] = self.particles(&self.triangles[triangle]);
        [[a, b], [b, c], [c, a]].contains(&joint.ends)
    }

    /// Turns those triangles of a piece over that are marked, or those that are not, whichever have less area.
    fn turn_smaller_part(&mut self, piece: &[usize], turned: &[Option<bool>]) {
        let area = |&triangle: &usize| {
            let [a, b, c] =
                self.triangles[triangle].vertices.map(|vertex| self.positions[vertex as usize]);
            let area = (b - a).cross(c - a).length();
            if turned[triangle] == Some(true) { area } else { -area }
        };
        let turns = piece.iter().map(area).sum::<f32>() <= 0.0;
        for &triangle in piece.iter().filter(|&&triangle| turned[triangle] == Some(turns)) {
            let Corners { triangle: number, vertices } = &mut self.triangles[triangle];
            vertices.swap(1, 2);
            self.report.turned.push(*number);
        }
    }

    /// The error of a piece without a consistent winding, at an edge of a triangle.
    fn one_sided(&self, triangle: usize, ends: [u32; 2]) -> FabricError {
        let corners = self.triangles[triangle].vertices;
        let vertex = |particle: u32| {
            let at = corners.iter().find(|&&at| self.particle_of_vertex[at as usize] == particle);
            at.copied().unwrap_or(corners[0])
        };
        FabricError::OneSided { a: vertex(ends[0]), b: vertex(ends[1]) }
    }
}
