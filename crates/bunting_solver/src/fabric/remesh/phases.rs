//! Two phases at each vertex, along warp and weft, which turn once in each cell. Places with whole turns of both are the nodes of a lattice.
//!
//! A phase is a complex number, so that the lattice closes around a mesh, and its lines end where they do not fit (Ray et al. 2006, *Periodic
//! global parameterization*; Knöppel et al. 2015, *Stripe patterns on surfaces*). Borders that run along an axis are lines of the
//! lattice: the phase across them is whole.

use core::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::frames::{Frame, turned};
use super::relaxation::{self, Phases, unit};
use super::steps::{Step, Steps};
use crate::fabric::topology::Edge;

/// Greatest sine of the angle between a border and an axis along which it runs.
const ALONG: f64 = 0.35;

/// The lattice of a mesh.
pub(super) struct Lattice {
    steps: Steps,
    /// The phases of each vertex, turns.
    turns: Vec<DVec2>,
}

impl Lattice {
    /// The lattice with a cell's size (m) on a mesh with a frame at each vertex.
    pub fn of(positions: &[DVec3], edges: &[Edge], frames: &[Frame], size: f64) -> Self {
        let steps = Steps::of(positions, edges, frames, size);
        let mut phases = guess(frames.len(), &steps);
        relaxation::relax(&mut phases, &steps, &is_whole(edges, &steps, frames.len()));
        let turns = |at: DVec2| libm::atan2(at.y, at.x) / TAU;
        let turns = phases.iter().map(|[one, other]| DVec2::new(turns(*one), turns(*other)));
        Self { turns: turns.collect(), steps }
    }

    /// The phases of a vertex, turns.
    pub fn turns(&self, vertex: u32) -> DVec2 {
        self.turns[vertex as usize]
    }

    /// By how much the phases change from one end of an edge to the other, turns, and the quarter turns to its axes; none if no edge
    /// joins them.
    pub fn change(&self, from: u32, to: u32) -> Option<(DVec2, u8)> {
        let Step { quarters, vector, .. } = self.steps.between(from, to)?;
        let off = turned(self.turns(to), quarters) - self.turns(from) - vector;
        Some((vector + off - off.round(), quarters))
    }

    /// The phases at the corners of a triangle along the axes of the first one, turns; none where lines end, so that they do not agree.
    pub fn of_triangle(&self, [a, b, c]: [u32; 3]) -> Option<[DVec2; 3]> {
        let (to_b, at_b) = self.change(a, b)?;
        let (to_c, at_c) = self.change(a, c)?;
        let (from_b, from_b_at_c) = self.change(b, c)?;
        let around = to_b + turned(from_b, at_b);
        // Other sums differ by whole turns.
        let agree = (at_b + from_b_at_c) % 4 == at_c && around.distance(to_c) < 0.5;
        let first = self.turns(a);
        agree.then_some([first, first + to_b, first + to_c])
    }
}

/// Whether each phase of each vertex is whole: that across a border along the other axis.
fn is_whole(edges: &[Edge], steps: &Steps, count: usize) -> Vec<[bool; 2]> {
    let mut is_whole = vec![[false; 2]; count];
    for edge in edges.iter().filter(|edge| edge.other_side.is_none()) {
        let [one, other] = edge.ends;
        for (from, to) in [(one, other), (other, one)] {
            let Some(Step { vector, .. }) = steps.between(from, to) else { continue };
            for (axis, is_whole) in is_whole[from as usize].iter_mut().enumerate() {
                *is_whole |= vector[axis].abs() < ALONG * vector.length();
            }
        }
    }
    is_whole
}

/// Phases that agree along a tree of edges, breadth first.
fn guess(count: usize, steps: &Steps) -> Vec<Phases> {
    let mut turns: Vec<Option<DVec2>> = vec![None; count];
    for start in 0..count {
        if turns[start].is_some() {
            continue;
        }
        turns[start] = Some(DVec2::ZERO);
        let mut front = vec![start as u32];
        let mut next = 0;
        while let Some(&from) = front.get(next) {
            next += 1;
            let here = turns[from as usize].unwrap_or_default();
            for &Step { to, quarters, vector, .. } in steps.from(from) {
                if turns[to as usize].is_none() {
                    turns[to as usize] = Some(turned(here + vector, 4 - quarters));
                    front.push(to);
                }
            }
        }
    }
    let phases = |turns: Option<DVec2>| {
        let turns = turns.unwrap_or_default();
        [turns.x, turns.y].map(|turns| unit(TAU * turns))
    };
    turns.into_iter().map(phases).collect()
}
