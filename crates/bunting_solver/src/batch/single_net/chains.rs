//! Chains of a single net, in packs of lines of one colour.

use std::collections::HashMap;

use super::lane_indices::{LaneIndices, NO_INDEX};
use super::node_packs::NodePacks;
use super::pack_lanes::{PackLane, lanes_of_open, packs_of_rings};
use crate::fabric::{Cell, Chain, ChainLink, Chains, Fabric, Yarn, ascending};
use crate::simd::constant::Constant;
use crate::simd::lane::Pack;
use crate::simd::registers::Pack8;

/// Packs of chains.
#[derive(Clone, Debug)]
pub(super) struct ChainPacks {
    /// The `class` of a link is an index into `classes`.
    pub chains: Chains<Pack8>,
    /// For each class of links of packs, the fabric's class in each lane.
    pub classes: Vec<LaneIndices>,
}

impl ChainPacks {
    pub fn new(fabric: &Fabric, nodes: &mut NodePacks) -> Self {
        let mut packer = Packer { fabric, nodes, classes: Vec::new(), known: HashMap::new() };
        let colours = fabric.yarn_colours().ranges().iter().map(|range| {
            let yarns = &fabric.yarns()[range.clone()];
            let family = fabric.links()[yarns[0].links[0] as usize].family;
            (family, packer.pack(yarns))
        });
        let mut chains = Chains::of_colours(colours.collect::<Vec<_>>().into_iter());
        chains.sweep_diagonals();
        let classes = packer.classes;
        (chains.cells, chains.diagonal_lengths) = cells(fabric, &chains, nodes);
        Self { chains, classes }
    }
}

/// Packs lines of one colour.
struct Packer<'a> {
    fabric: &'a Fabric,
    nodes: &'a mut NodePacks,
    classes: Vec<LaneIndices>,
    /// The class with these classes of the fabric in its lanes.
    known: HashMap<LaneIndices, u32>,
}

impl Packer<'_> {
    /// Packs lines that share no node: rings, then others.
    fn pack(&mut self, yarns: &[Yarn]) -> Vec<Chain<Pack8>> {
        let (rings, open): (Vec<&Yarn>, Vec<&Yarn>) = yarns.iter().partition(|yarn| yarn.is_ring());
        let rings = packs_of_rings(&rings);
        let rings = rings.iter().map(|lanes| (&lanes[..], true));
        let open = lanes_of_open(&open);
        let open = open.chunks(Pack8::WIDTH).map(|lanes| (lanes, false));
        rings.chain(open).map(|(lanes, is_closed)| self.chain(lanes, is_closed)).collect()
    }

    fn chain(&mut self, lanes: &[PackLane], is_closed: bool) -> Chain<Pack8> {
        let nodes: Vec<&[u32]> = lanes.iter().map(|lane| &lane.nodes[..]).collect();
        let particles = self.nodes.along(&nodes);
        let links = (0..particles.len() - 1).map(|row| self.link(lanes, row)).collect();
        let leading = lanes.iter().map(PackLane::leading).max().unwrap_or(0);
        Chain::new(particles, links, is_closed, leading)
    }

    /// The links in a row of each lane.
    fn link(&mut self, lanes: &[PackLane], row: usize) -> ChainLink<Pack8> {
        let link = |lane: usize| {
            let number = lanes.get(lane)?.link(row)?;
            self.fabric.links().get(number as usize)
        };
        let rest_length =
            <Pack8 as Constant<Pack8>>::of(|lane| link(lane).map_or(0.0, |link| link.rest_length));
        let of_lanes = core::array::from_fn(|lane| link(lane).map_or(NO_INDEX, |link| link.class));
        let class = *self.known.entry(of_lanes).or_insert_with(|| {
            self.classes.push(of_lanes);
            self.classes.len() as u32 - 1
        });
        ChainLink { class, rest_length }
    }
}

/// The cells whose diagonals are links, one for each link of a pack of diagonals, and the lengths of their two diagonals at
/// rest, m; one in lanes without a cell.
fn cells(
    fabric: &Fabric,
    chains: &Chains<Pack8>,
    nodes: &mut NodePacks,
) -> (Vec<Cell>, Vec<[Pack8; 2]>) {
    // The other diagonal of the cell of each one. Where several cells have a diagonal, the last one sets its target.
    let mut others: HashMap<[u32; 2], [u32; 2]> = HashMap::new();
    for cell in &fabric.chains().cells {
        let [first, left, right, last] = cell.corners;
        others.insert(ascending([left, right]), [first, last]);
        others.insert(ascending([first, last]), [left, right]);
    }
    let rest = fabric.rest_positions();
    let of_link = |([from, to], target): ([u32; 2], u32)| {
        let ends: [[u32; 2]; Pack8::WIDTH] = {
            let [from, to] = [from, to].map(|end| nodes.of[end as usize]);
            core::array::from_fn(|lane| [from[lane], to[lane]])
        };
        let opposite = ends.map(|ends| others.get(&ascending(ends)).copied());
        let sides = [0, 1].map(|side| nodes.index_of(opposite.map(|of| of.map(|of| of[side]))));
        let length = |of: &dyn Fn(usize) -> Option<[u32; 2]>| {
            <Pack8 as Constant<Pack8>>::of(|lane| {
                of(lane).map_or(1.0, |[a, b]| rest[a as usize].distance(rest[b as usize]))
            })
        };
        let own = length(&|lane| opposite[lane].map(|_| ends[lane]));
        let other = length(&|lane| opposite[lane]);
        let [left, right] = sides;
        (Cell { corners: [from, left, right, to], targets: [target; 2] }, [own, other])
    };
    chains.diagonals().map(of_link).unzip()
}
