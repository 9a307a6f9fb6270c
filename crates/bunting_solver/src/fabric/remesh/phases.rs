//! Two phases at each vertex, along warp and weft, which turn once in each cell. Places with whole turns of both are the nodes of a lattice.
//!
//! A phase is a complex number, so that the lattice closes around a mesh, and its lines end where they do not fit (Ray et al. 2006, *Periodic
//! global parameterization*; Knöppel et al. 2015, *Stripe patterns on surfaces*). Borders that run along an axis are lines of the
//! lattice: the phase across them is whole.

use core::f64::consts::TAU;
use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use super::cotangent;
use super::frames::{Frame, turned};
use super::phase_energy::{EdgeTerm, PhaseEnergy, Phases};
use crate::fabric::topology::{Edge, Side, ascending};

/// How often phases are found from those before. Fewer: more lines end.
const ROUNDS: usize = 8;

/// Greatest sine of the angle between a border and an axis along which it runs.
const ALONG: f64 = 0.35;

/// An edge as seen from its first end.
#[derive(Clone, Copy, Debug)]
struct Step {
    /// The quarter turns after which the axes of the second end are nearest to those of the first.
    quarters: u8,
    /// The vector to the second end along the axes of the first, cells.
    vector: DVec2,
}

impl Step {
    /// The same edge as seen from its second end.
    fn back(self) -> Self {
        let quarters = (4 - self.quarters) % 4;
        Self { quarters, vector: -turned(self.vector, quarters) }
    }
}

/// The lattice of a mesh.
pub(super) struct Lattice {
    steps: BTreeMap<[u32; 2], Step>,
    /// The phases of each vertex, turns.
    turns: Vec<DVec2>,
}

impl Lattice {
    /// The lattice with a cell's size (m) on a mesh with a frame at each vertex.
    pub fn of(positions: &[DVec3], edges: &[Edge], frames: &[Frame], size: f64) -> Self {
        let step = |edge: &Edge| {
            let [one, other] = edge.ends.map(|at| at as usize);
            let quarters = frames[one].quarters_to(&frames[other]);
            let vector = positions[other] - positions[one];
            let vector = frames[one].vector_to(&frames[other], quarters, vector) / size;
            (edge.ends, Step { quarters, vector })
        };
        let steps: BTreeMap<[u32; 2], Step> = edges.iter().map(step).collect();
        let term = |edge: &Edge| {
            let Step { quarters, vector } = steps[&edge.ends];
            let turn = [vector.x, vector.y].map(|turns| unit(TAU * turns));
            EdgeTerm { ends: edge.ends, quarters, turn, weight: weight(edge, positions) }
        };
        let energy = PhaseEnergy {
            terms: edges.iter().map(term).collect(),
            is_whole: is_whole(edges, &steps, frames.len()),
        };
        let mut phases = guess(frames.len(), &steps);
        for _ in 0..ROUNDS {
            phases = energy.relaxed(&phases);
            for phase in phases.iter_mut().flatten() {
                *phase = phase.normalize_or(DVec2::X);
            }
        }
        let turns = |at: DVec2| libm::atan2(at.y, at.x) / TAU;
        let turns = phases.iter().map(|[one, other]| DVec2::new(turns(*one), turns(*other)));
        Self { turns: turns.collect(), steps }
    }

    /// The phases of a vertex, turns.
    pub fn turns(&self, vertex: u32) -> DVec2 {
        self.turns[vertex as usize]
    }

    /// By how much the phases change from one end of an edge to the other, turns, and the quarter turns to its axes.
    pub fn change(&self, from: u32, to: u32) -> (DVec2, u8) {
        let step = self.steps[&ascending([from, to])];
        let Step { quarters, vector } = if from < to { step } else { step.back() };
        let off = turned(self.turns(to), quarters) - self.turns(from) - vector;
        (vector + off - off.round(), quarters)
    }

    /// The phases at the corners of a triangle along the axes of the first one, turns; none where lines end, so that they do not agree.
    pub fn of_triangle(&self, [a, b, c]: [u32; 3]) -> Option<[DVec2; 3]> {
        let (to_b, at_b) = self.change(a, b);
        let (to_c, at_c) = self.change(a, c);
        let (from_b, from_b_at_c) = self.change(b, c);
        let around = to_b + turned(from_b, at_b);
        // Other sums differ by whole turns.
        let agree = (at_b + from_b_at_c) % 4 == at_c && around.distance(to_c) < 0.5;
        let first = self.turns(a);
        agree.then_some([first, first + to_b, first + to_c])
    }
}

/// A complex number with an angle, rad.
fn unit(angle: f64) -> DVec2 {
    DVec2::new(libm::cos(angle), libm::sin(angle))
}

/// Weight of an edge: the sum of the cotangents of the angles opposite to it, within bounds.
fn weight(edge: &Edge, positions: &[DVec3]) -> f64 {
    let [one, other] = edge.ends;
    let corners = |side: Side| [one, other, side.opposite].map(|at| positions[at as usize]);
    let sides = core::iter::once(edge.side).chain(edge.other_side);
    let sum: f64 = sides.map(|side| cotangent(corners(side))).sum();
    // Without bounds those of slivers rule.
    sum.clamp(0.1, 5.0)
}

/// Whether each phase of each vertex is whole: that across a border along the other axis.
fn is_whole(edges: &[Edge], steps: &BTreeMap<[u32; 2], Step>, count: usize) -> Vec<[bool; 2]> {
    let mut is_whole = vec![[false; 2]; count];
    for edge in edges.iter().filter(|edge| edge.other_side.is_none()) {
        let step = steps[&edge.ends];
        for (at, step) in edge.ends.into_iter().zip([step, step.back()]) {
            for (axis, is_whole) in is_whole[at as usize].iter_mut().enumerate() {
                *is_whole |= step.vector[axis].abs() < ALONG * step.vector.length();
            }
        }
    }
    is_whole
}

/// Phases that agree along a tree of edges, breadth first.
fn guess(count: usize, steps: &BTreeMap<[u32; 2], Step>) -> Vec<Phases> {
    let mut near: Vec<Vec<(u32, Step)>> = vec![Vec::new(); count];
    for (&[one, other], step) in steps {
        near[one as usize].push((other, *step));
        near[other as usize].push((one, step.back()));
    }
    let mut turns: Vec<Option<DVec2>> = vec![None; count];
    for start in 0..count {
        if turns[start].is_some() {
            continue;
        }
        turns[start] = Some(DVec2::ZERO);
        let mut front = vec![start];
        let mut next = 0;
        while let Some(&from) = front.get(next) {
            next += 1;
            let here = turns[from].unwrap_or_default();
            for &(to, Step { quarters, vector }) in &near[from] {
                let to = to as usize;
                if turns[to].is_none() {
                    turns[to] = Some(turned(here + vector, 4 - quarters));
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
