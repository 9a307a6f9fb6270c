//! Triangles without area.

use std::collections::BTreeMap;

use glam::Vec3;

use super::{Corners, Repairing};

impl Repairing {
    /// Flips the longest edges of triangles whose corners lie on a line, so that the neighbour across that edge is
    /// joined to all three corners; then removes triangles that still have no area.
    pub(super) fn remove_degenerate(&mut self) {
        // A flip may hand a corner on to the next triangle on the same line, which the next pass flips.
        while self.flip_once() {}
        let all = core::mem::take(&mut self.triangles);
        let (kept, removed): (_, Vec<Corners>) =
            all.into_iter().partition(|corners| self.has_area(corners));
        self.triangles = kept;
        self.report.degenerate = removed.iter().map(|corners| corners.triangle).collect();
    }

    /// Flips each edge that should be, unless its triangles have changed in this pass. Returns whether there was one.
    fn flip_once(&mut self) -> bool {
        let flat: Vec<usize> =
            (0..self.triangles.len()).filter(|&at| !self.has_area(&self.triangles[at])).collect();
        if flat.is_empty() {
            return false;
        }
        let mut at_side = BTreeMap::new();
        for (index, Corners { vertices: [a, b, c], .. }) in self.triangles.iter().enumerate() {
            at_side.extend([((*a, *b), index), ((*b, *c), index), ((*c, *a), index)]);
        }
        let mut is_changed = vec![false; self.triangles.len()];
        let mut any = false;
        for triangle in flat {
            let [from, to, tip] = self.longest_side_first(self.triangles[triangle].vertices);
            let Some(&other) = at_side.get(&(to, from)) else { continue };
            if is_changed[triangle] || is_changed[other] {
                continue;
            }
            let neighbour = self.triangles[other].vertices;
            let opposite = neighbour.into_iter().find(|&at| at != from && at != to);
            let Some(opposite) = opposite else { continue };
            let one = Corners { vertices: [tip, from, opposite], ..self.triangles[triangle] };
            let two = Corners { vertices: [opposite, to, tip], ..self.triangles[other] };
            if self.has_area(&one) && self.has_area(&two) {
                self.report.flipped.push(self.triangles[triangle].triangle);
                [self.triangles[triangle], self.triangles[other]] = [one, two];
                (is_changed[triangle], is_changed[other], any) = (true, true, true);
            }
        }
        any
    }

    /// The corners of a triangle, in its winding, from an end of its longest side on.
    fn longest_side_first(&self, [a, b, c]: [u32; 3]) -> [u32; 3] {
        let at = |vertex: u32| -> Vec3 { self.positions[vertex as usize] };
        let length = |[from, to, _]: &[u32; 3]| at(*from).distance_squared(at(*to));
        let [first, rest @ ..] = [[a, b, c], [b, c, a], [c, a, b]];
        rest.into_iter().fold(
            first,
            |best, turn| {
                if length(&turn) > length(&best) { turn } else { best }
            },
        )
    }
}
