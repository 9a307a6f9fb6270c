//! The heights of a single mesh's particles above the surface between the nodes of its background grid, eight at once.

use super::vectors::pack_count;
use crate::constraints::background::raised;
use crate::fabric::Height;
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::registers::{Pack4, Pack8};
use crate::simd::vec3::{Pack3, V3};

/// The heights of a mesh's particles, in the packs of the particles; none if the mesh is flat at rest.
#[derive(Clone, Debug)]
pub(crate) struct HeightPacks(Vec<HeightPack>);

/// As [`Height`]; particles without one have zeros.
#[derive(Clone, Copy, Debug)]
struct HeightPack {
    nodes: [[u32; Pack8::WIDTH]; 4],
    along: [Pack8; 2],
    height: Pack8,
}

impl HeightPacks {
    /// The heights of some of `particles` particles, with nodes at their places among the vectors of nodes.
    pub fn new(heights: &[Height], particles: usize, places: &[u32]) -> Self {
        let zero = Pack8::splat(0.0);
        let none = HeightPack { nodes: [[0; Pack8::WIDTH]; 4], along: [zero; 2], height: zero };
        let count = if heights.is_empty() { 0 } else { pack_count(particles) };
        let mut packs = vec![none; count];
        for Height { particle, nodes, along, height } in heights {
            let (pack, lane) = super::locate(*particle as usize);
            let pack = &mut packs[pack];
            for (of_lanes, &node) in pack.nodes.iter_mut().zip(nodes) {
                of_lanes[lane] = places[node as usize];
            }
            for (of_lanes, &along) in pack.along.iter_mut().zip(along) {
                of_lanes.lanes_mut()[lane] = along;
            }
            pack.height.lanes_mut()[lane] = *height;
        }
        Self(packs)
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

/// Raises particles by their heights, or lowers them.
pub(crate) struct AddHeightPacks<'a> {
    pub heights: &'a HeightPacks,
    pub sign: f32,
    /// Positions of the nodes, m.
    pub nodes: &'a [Pack4],
    pub to: &'a mut [Pack3<Pack8>],
}

impl Kernel<Pack8> for AddHeightPacks<'_> {
    #[inline(always)]
    fn run<L: Lane<Pack = Pack8>>(self, token: L::Token) {
        let sign = L::splat(token, self.sign);
        for (HeightPack { nodes, along, height }, to) in self.heights.0.iter().zip(self.to) {
            let nodes: [V3<L>; 4] = [
                V3::gather(token, self.nodes, &nodes[0]),
                V3::gather(token, self.nodes, &nodes[1]),
                V3::gather(token, self.nodes, &nodes[2]),
                V3::gather(token, self.nodes, &nodes[3]),
            ];
            let [x, y] = along;
            let at = [L::load(token, x), L::load(token, y), L::load(token, height)];
            raised(token, V3::load(token, to), nodes, sign, at).store(to);
        }
    }
}
