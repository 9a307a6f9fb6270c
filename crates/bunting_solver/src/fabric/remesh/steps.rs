//! The edges at each vertex, as steps along the axes of its frame.

use core::ops::Range;

use glam::{DVec2, DVec3};

use super::frames::{Frame, turned};
use super::triangle::cotangent;
use crate::fabric::topology::{Edge, Side};

/// Bounds of the weight of an edge. Without them those of slivers rule.
const LEAST_WEIGHT: f64 = 0.1;
const GREATEST_WEIGHT: f64 = 5.0;

/// An edge as seen from one of its ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step {
    /// The other end.
    pub to: u32,
    /// The quarter turns after which the axes of the other end are nearest to those of this one.
    pub quarters: u8,
    /// The vector to the other end along the axes of this one, cells.
    pub vector: DVec2,
    /// Sum of the cotangents of the angles opposite to the edge, within bounds.
    pub weight: f64,
}

/// The steps from all vertices of a mesh.
pub(super) struct Steps {
    /// The steps from each vertex, one vertex after the other.
    all: Vec<Step>,
    /// Of each vertex the first of its steps, and their number at the end.
    firsts: Vec<usize>,
}

impl Steps {
    /// The edges of a mesh with a frame at each vertex, in cells of a size (m).
    pub fn of(positions: &[DVec3], edges: &[Edge], frames: &[Frame], size: f64) -> Self {
        let mut from: Vec<(u32, Step)> = Vec::with_capacity(2 * edges.len());
        for edge in edges {
            let [one, other] = edge.ends;
            let [here, there] = edge.ends.map(|at| frames[at as usize]);
            let quarters = here.quarters_to(&there);
            let vector = positions[other as usize] - positions[one as usize];
            let vector = here.vector_to(&there, quarters, vector) / size;
            let weight = weight(edge, positions);
            from.push((one, Step { to: other, quarters, vector, weight }));
            let back = (4 - quarters) % 4;
            from.push((
                other,
                Step { to: one, quarters: back, vector: -turned(vector, back), weight },
            ));
        }
        Self::sorted(from, positions.len())
    }

    /// Steps with the vertices that they start from.
    pub fn sorted(mut from: Vec<(u32, Step)>, vertex_count: usize) -> Self {
        from.sort_by_key(|(vertex, step)| (*vertex, step.to));
        let first = |vertex: usize| from.partition_point(|(from, _)| (*from as usize) < vertex);
        let firsts = (0..=vertex_count).map(first).collect();
        Self { firsts, all: from.into_iter().map(|(_, step)| step).collect() }
    }

    /// The steps from all vertices, one vertex after the other.
    pub fn all(&self) -> &[Step] {
        &self.all
    }

    /// The numbers of the steps from a vertex among all of them.
    pub fn numbers_from(&self, vertex: u32) -> Range<usize> {
        let vertex = vertex as usize;
        self.firsts[vertex]..self.firsts[vertex + 1]
    }

    /// The steps from a vertex.
    pub fn from(&self, vertex: u32) -> &[Step] {
        &self.all[self.numbers_from(vertex)]
    }

    /// The step from one end of an edge to the other.
    pub fn between(&self, from: u32, to: u32) -> Option<Step> {
        self.from(from).iter().find(|step| step.to == to).copied()
    }
}

/// Weight of an edge: the sum of the cotangents of the angles opposite to it, within bounds.
fn weight(edge: &Edge, positions: &[DVec3]) -> f64 {
    let [one, other] = edge.ends;
    let corners = |side: Side| [one, other, side.opposite].map(|at| positions[at as usize]);
    let sides = core::iter::once(edge.side).chain(edge.other_side);
    let sum: f64 = sides.map(|side| cotangent(corners(side))).sum();
    sum.clamp(LEAST_WEIGHT, GREATEST_WEIGHT)
}
