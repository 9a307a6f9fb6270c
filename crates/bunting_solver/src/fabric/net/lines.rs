//! The lines of a net: sides of cells, each joined to those that go straight on from it.

use glam::Vec3;

use super::cell::Cell;
use crate::fabric::topology::ascending;

/// Least cosine of the angle by which a line turns at a node. Larger: lines end at sharp folds. Smaller: they turn back.
const STRAIGHT: f32 = 0.0;

/// A line of nodes.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Line {
    /// The first one is also the last one of a ring.
    pub nodes: Vec<u32>,
}

impl Line {
    pub fn is_ring(&self) -> bool {
        self.nodes.first() == self.nodes.last()
    }

    /// Each node with those before and after it on the line.
    pub fn threes(&self) -> impl Iterator<Item = [u32; 3]> {
        let inner = self.nodes.windows(3).map(|three| [three[0], three[1], three[2]]);
        let closing = match self.nodes[..] {
            [first, second, .., before, last] if first == last => Some([before, first, second]),
            _ => None,
        };
        inner.chain(closing)
    }
}

/// The lines through all sides of the cells; none if a line leads along what is no side.
pub(super) fn lines(cells: &[Cell], positions: &[Vec3]) -> Option<Vec<Line>> {
    let mut sides: Vec<[u32; 2]> = cells.iter().flat_map(Cell::sides).map(ascending).collect();
    sides.sort_unstable();
    sides.dedup();
    let pairs = pairs_at_nodes(cells, &sides, positions);
    let next = |from: u32, at: u32| {
        let pair = pairs[at as usize].iter().find(|pair| pair.contains(&from))?;
        pair.iter().copied().find(|other| *other != from)
    };
    let mut is_taken = vec![false; sides.len()];
    let number = |ends: [u32; 2]| sides.binary_search(&ascending(ends)).ok();
    let mut lines = Vec::new();
    for (side, &[one, other]) in sides.iter().enumerate() {
        if is_taken[side] {
            continue;
        }
        // Back to the beginning of the line, or once around.
        let (mut at, mut after) = (one, other);
        while let Some(before) = next(after, at) {
            (at, after) = (before, at);
            if (at, after) == (one, other) {
                break;
            }
        }
        is_taken[number([at, after])?] = true;
        let mut nodes = vec![at, after];
        while let Some(to) = next(at, after) {
            if core::mem::replace(&mut is_taken[number([after, to])?], true) {
                break;
            }
            nodes.push(to);
            (at, after) = (after, to);
        }
        without_crossings(nodes, &mut lines);
    }
    Some(lines)
}

/// Adds the parts of a line that crosses itself, which has no node twice in any of them.
fn without_crossings(nodes: Vec<u32>, into: &mut Vec<Line>) {
    let mut part: Vec<u32> = Vec::new();
    let (first, last) = (nodes[0], nodes.len() - 1);
    for (at, &node) in nodes.iter().enumerate() {
        let closes = at == last && node == first && part[0] == first;
        if !closes && let (true, Some(&end)) = (part.contains(&node), part.last()) {
            into.push(Line { nodes: core::mem::replace(&mut part, vec![end]) });
        }
        part.push(node);
    }
    into.push(Line { nodes: part });
}

/// The pairs of neighbours of each node through which a line goes on.
fn pairs_at_nodes(cells: &[Cell], sides: &[[u32; 2]], positions: &[Vec3]) -> Vec<Vec<[u32; 2]>> {
    let mut neighbours: Vec<Vec<u32>> = vec![Vec::new(); positions.len()];
    for &[one, other] in sides {
        neighbours[one as usize].push(other);
        neighbours[other as usize].push(one);
    }
    // Two sides of one cell are no line.
    let mut turns: Vec<Vec<[u32; 2]>> = vec![Vec::new(); positions.len()];
    for [before, at, after] in cells.iter().flat_map(Cell::threes) {
        turns[at as usize].push(ascending([before, after]));
    }
    let straightest = |(node, near): (usize, &Vec<u32>)| {
        let direction = |to: u32| (positions[to as usize] - positions[node]).normalize();
        let mut pairs: Vec<(f32, [u32; 2])> = Vec::new();
        for (at, &one) in near.iter().enumerate() {
            for &other in &near[at + 1..] {
                let straight = -direction(one).dot(direction(other));
                if straight > STRAIGHT && !turns[node].contains(&ascending([one, other])) {
                    pairs.push((straight, [one, other]));
                }
            }
        }
        pairs.sort_by(|one, other| other.0.total_cmp(&one.0));
        let mut taken: Vec<[u32; 2]> = Vec::new();
        for (_, pair) in pairs {
            if !taken.as_flattened().iter().any(|at| pair.contains(at)) {
                taken.push(pair);
            }
        }
        taken
    };
    neighbours.iter().enumerate().map(straightest).collect()
}
