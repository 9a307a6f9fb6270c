//! Lines of a net that share no node, laid into the lanes of packs.
//!
//! A row of a pack takes as long whether one lane has a link in it or all of them. Lines are therefore laid close: short ones one
//! after another in a lane, with no link between them, and rings of any lengths side by side. Every link is solved with the numbers
//! that it has in a pack of its own, so that no bit depends on how lines are laid.

use core::cmp::Reverse;
use core::iter::repeat_n;

use crate::fabric::{CHAINS_PER_PAIR, Yarn};
use crate::simd::lane::Pack;
use crate::simd::registers::Pack8;

/// Lines one after another in a lane.
#[derive(Debug)]
pub(super) struct PackLane {
    /// One more than rows of links.
    pub nodes: Vec<u32>,
    /// The number of the fabric's link in each row; none before and between lines.
    links: Vec<Option<u32>>,
}

impl PackLane {
    /// A lane with one line, which ends in the last of a number of rows. The rows before it stay at its first node.
    fn ending_in(rows: usize, yarn: &Yarn) -> Self {
        let leading = rows - yarn.links.len();
        let mut lane = Self {
            nodes: repeat_n(yarn.particles[0], leading).collect(),
            links: vec![None; leading],
        };
        lane.push(yarn);
        lane
    }

    fn push(&mut self, yarn: &Yarn) {
        self.links.extend(yarn.links.iter().copied().map(Some));
        self.nodes.extend(&yarn.particles);
    }

    /// Adds a line behind those that are there.
    fn append(&mut self, yarn: &Yarn) {
        let gap = self.gap();
        self.links.extend(repeat_n(None, gap));
        self.nodes.extend(repeat_n(yarn.particles[0], gap - 1));
        self.push(yarn);
    }

    /// Number of rows between the last line and another one, which begins in an even row: a sweep solves every second link of a line,
    /// then the others, and so every second row of a pack.
    fn gap(&self) -> usize {
        2 - self.links.len() % 2
    }

    /// The number of the fabric's link in a row.
    pub fn link(&self, row: usize) -> Option<u32> {
        *self.links.get(row)?
    }

    /// Number of rows before the first link.
    pub fn leading(&self) -> usize {
        self.links.iter().take_while(|link| link.is_none()).count()
    }
}

/// Packs of rings that end in the last row of their pack. Packs that are solved side by side follow one another with as many rows.
pub(super) fn packs_of_rings(rings: &[&Yarn]) -> Vec<Vec<PackLane>> {
    let mut rings = rings.to_vec();
    rings.sort_by_key(|yarn| Reverse(yarn.links.len()));
    let packs: Vec<&[&Yarn]> = rings.chunks(Pack8::WIDTH).collect();
    let rows = |pack: &&[&Yarn]| pack[0].links.len();
    // Two packs side by side take less time than one after the other, unless one of them is much shorter.
    let side_by_side = packs.chunk_by(|one, other| 2 * rows(other) > rows(one));
    let pairs = side_by_side.flat_map(|run| run.chunks(CHAINS_PER_PAIR));
    let lanes = |pair: &[&[&Yarn]]| -> Vec<Vec<PackLane>> {
        let longest = rows(&pair[0]);
        let lanes =
            |pack: &&[&Yarn]| pack.iter().map(|yarn| PackLane::ending_in(longest, yarn)).collect();
        pair.iter().map(lanes).collect()
    };
    pairs.flat_map(lanes).collect()
}

/// Lanes of lines that are no rings, none with more rows than the longest line. Lines are taken from the longest to the shortest, each
/// into the first lane that has room (first-fit decreasing).
pub(super) fn lanes_of_open(lines: &[&Yarn]) -> Vec<PackLane> {
    let mut lines = lines.to_vec();
    lines.sort_by_key(|yarn| Reverse(yarn.links.len()));
    let longest = lines.first().map_or(0, |yarn| yarn.links.len());
    let mut lanes: Vec<PackLane> = Vec::new();
    for yarn in lines {
        let rows = yarn.links.len();
        let has_room = |lane: &&mut PackLane| lane.links.len() + lane.gap() + rows <= longest;
        match lanes.iter_mut().find(has_room) {
            Some(lane) => lane.append(yarn),
            None => lanes.push(PackLane::ending_in(rows, yarn)),
        }
    }
    lanes
}

#[cfg(test)]
mod tests {
    use super::{PackLane, lanes_of_open, packs_of_rings};
    use crate::fabric::Yarn;

    /// Lines of some numbers of links, which share no node.
    fn lines(lengths: &[u32], is_ring: bool) -> Vec<Yarn> {
        let line = |(at, &length): (usize, &u32)| {
            let first = 100 * at as u32;
            let nodes = first..first + length;
            let end = if is_ring { first } else { first + length };
            Yarn { particles: nodes.clone().chain([end]).collect(), links: nodes.collect() }
        };
        lengths.iter().enumerate().map(line).collect()
    }

    /// Link numbers are those of the nodes at which they begin: each of a lane's links joins the nodes that it joins in its line.
    fn check_links(lanes: &[PackLane], lines: &[Yarn]) {
        let ends = |lane: &PackLane| {
            assert_eq!(lane.nodes.len(), lane.links.len() + 1);
            let rows = lane.nodes.windows(2).zip(&lane.links);
            let linked = rows.filter_map(|(ends, link)| Some(((*link)?, ends.to_vec())));
            linked.collect::<Vec<_>>()
        };
        let mut found: Vec<_> = lanes.iter().flat_map(ends).collect();
        found.sort_unstable();
        let of_line = |line: &Yarn| -> Vec<_> {
            let ends = line.particles.windows(2).map(<[u32]>::to_vec);
            line.links.iter().copied().zip(ends).collect()
        };
        assert_eq!(found, lines.iter().flat_map(of_line).collect::<Vec<_>>());
    }

    #[test]
    fn rings_of_different_lengths_share_packs_and_end_in_one_row() {
        let rings = lines(&[20, 21, 22, 24, 25, 26, 27, 28, 8, 19, 22], true);
        let packs = packs_of_rings(&rings.iter().collect::<Vec<_>>());
        assert_eq!(packs.iter().map(Vec::len).collect::<Vec<_>>(), [8, 3]);
        for lane in packs.iter().flatten() {
            assert_eq!(lane.links.len(), 28);
            let length = lane.links.iter().flatten().count();
            assert_eq!(lane.leading(), 28 - length);
            assert!(lane.link(27).is_some());
            let [before_first @ .., first] = &lane.nodes[..=lane.leading()] else { panic!() };
            assert!(before_first.iter().all(|node| node == first));
        }
        check_links(&packs.into_iter().flatten().collect::<Vec<_>>(), &rings);
        // A pack of eight, and one that is much shorter.
        let rings = lines(&[20, 20, 20, 20, 20, 20, 20, 20, 8], true);
        let packs = packs_of_rings(&rings.iter().collect::<Vec<_>>());
        let rows: Vec<usize> = packs.iter().map(|pack| pack[0].links.len()).collect();
        assert_eq!(rows, [20, 8]);
    }

    #[test]
    fn short_lines_share_a_lane_and_begin_in_even_rows() {
        let lines = lines(&[3, 12, 30, 13, 1, 30, 2], false);
        let lanes = lanes_of_open(&lines.iter().collect::<Vec<_>>());
        let rows: Vec<usize> = lanes.iter().map(|lane| lane.links.len()).collect();
        assert_eq!(rows, [30, 30, 13 + 1 + 12 + 2 + 2, 3 + 1 + 1]);
        for (row, link) in lanes.iter().flat_map(|lane| lane.links.iter().enumerate()) {
            // The hundreds of a number are those of its line.
            assert!(link.is_none_or(|number| number % 100 % 2 == row as u32 % 2));
        }
        assert!(lanes.iter().all(|lane| lane.leading() == 0));
        check_links(&lanes, &lines);
    }
}
