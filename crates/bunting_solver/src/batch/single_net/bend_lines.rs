//! Bend lines of a single net, in packs of lines that share no node.

use super::in_order::packs_in_order;
use super::lane_indices::{LaneIndices, NO_INDEX};
use super::node_packs::NodePacks;
use crate::fabric::{BendLine, Fabric};
use crate::simd::lane::Pack;
use crate::simd::registers::Pack8;

/// Packs of rows, then of columns.
#[derive(Clone, Debug)]
pub(super) struct BendLinePacks {
    /// The `profile` of a pack is an index into `profiles`.
    pub lines: Vec<BendLine>,
    /// For each pack, the fabric's profile in each lane.
    pub profiles: Vec<LaneIndices>,
}

impl BendLinePacks {
    pub fn new(fabric: &Fabric, nodes: &mut NodePacks) -> Self {
        let mut packs = Self { lines: Vec::new(), profiles: Vec::new() };
        for lines in fabric.bend_lines().chunk_by(|one, other| one.is_row == other.is_row) {
            let particles = lines.iter().map(|line| &line.particles[..]);
            for pack in packs_in_order(Pack8::WIDTH, fabric.particle_count(), particles) {
                let line = |lane: usize| pack.get(lane).map(|&line| &lines[line]);
                let particles: Vec<&[u32]> =
                    pack.iter().map(|&line| &lines[line].particles[..]).collect();
                packs.lines.push(BendLine {
                    is_row: lines[0].is_row,
                    particles: nodes.along(&particles),
                    profile: packs.profiles.len() as u32,
                });
                packs.profiles.push(core::array::from_fn(|lane| {
                    line(lane).map_or(NO_INDEX, |line| line.profile)
                }));
            }
        }
        packs
    }
}
