//! Packs of nodes that constraints gather.

use std::collections::HashMap;

use super::vectors::pack_count;
use crate::simd::lane::Pack;
use crate::simd::registers::Pack8;

/// The nodes in the lanes of a pack.
pub(super) type NodePack = [u32; Pack8::WIDTH];

/// The packs that constraints gather while they are found. The first ones are the packs of the state. A lane without a node has the
/// number behind all of these, at which there is a vector that nothing moves.
pub(super) struct NodePacks {
    /// The pack at each index by which constraints access particles.
    pub of: Vec<NodePack>,
    /// The number of a lane's node where it has none.
    none: u32,
    /// The index of each pack.
    known: HashMap<NodePack, u32>,
}

impl NodePacks {
    /// The packs of the state of a number of nodes.
    pub fn new(count: usize) -> Self {
        let packs = pack_count(count);
        let none = (packs * Pack8::WIDTH) as u32;
        let mut nodes = Self { of: Vec::new(), none, known: HashMap::new() };
        for first in (0..none).step_by(Pack8::WIDTH) {
            nodes.index_of(core::array::from_fn(|lane| Some(first + lane as u32)));
        }
        nodes
    }

    /// The index with these nodes in its lanes.
    pub fn index_of(&mut self, nodes: [Option<u32>; Pack8::WIDTH]) -> u32 {
        let nodes = nodes.map(|node| node.unwrap_or(self.none));
        *self.known.entry(nodes).or_insert_with(|| {
            self.of.push(nodes);
            self.of.len() as u32 - 1
        })
    }

    /// Indices along lines, one line in each lane, up to the end of the longest one.
    pub fn along(&mut self, lines: &[&[u32]]) -> Vec<u32> {
        let longest = lines.iter().map(|line| line.len()).max().unwrap_or(0);
        let at = |place: usize| {
            core::array::from_fn(|lane| lines.get(lane).and_then(|line| line.get(place)).copied())
        };
        (0..longest).map(|place| self.index_of(at(place))).collect()
    }
}
