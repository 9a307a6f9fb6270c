//! The features of a cell: its triangles, and the edges and particles that belong to it alone.

use core::ops::Range;

use crate::simd::lane::Pack;
use crate::simd::registers::Pack8;

/// Up to eight features of a kind, one in each lane.
#[derive(Clone, Debug)]
pub(in crate::contact) struct FeaturePack {
    /// The particles of each: three corners, or two ends and the second again, or one particle three times. Lanes without a feature have
    /// the last one.
    pub particles: [[u32; Pack8::WIDTH]; 3],
    /// Index of the first one, if they are edges.
    pub first: u32,
    pub count: usize,
}

impl FeaturePack {
    /// Puts features into packs behind others, given the index of the first. Returns the indices of the packs.
    pub fn add(features: &[[u32; 3]], first: u32, packs: &mut Vec<Self>) -> Range<u32> {
        let begin = packs.len() as u32;
        for (index, chunk) in features.chunks(Pack8::WIDTH).enumerate() {
            let of_lane = |lane: usize| chunk[lane.min(chunk.len() - 1)];
            packs.push(Self {
                particles: core::array::from_fn(|at| {
                    core::array::from_fn(|lane| of_lane(lane)[at])
                }),
                first: first + (index * Pack8::WIDTH) as u32,
                count: chunk.len(),
            });
        }
        begin..packs.len() as u32
    }

    /// The pack among others, with larger indices of edges and particles.
    pub fn moved(&self, edges: u32, particles: u32) -> Self {
        Self {
            particles: self.particles.map(|lanes| lanes.map(|particle| particle + particles)),
            first: self.first + edges,
            count: self.count,
        }
    }

    /// The particles of a feature.
    pub fn of(&self, lane: u8) -> [u32; 3] {
        self.particles.map(|lanes| lanes[lane as usize])
    }

    /// One bit for each lane with a feature.
    #[inline(always)]
    pub fn lanes(&self) -> u64 {
        (1 << self.count) - 1
    }
}

/// Indices of the packs of a cell's features.
#[derive(Clone, Debug)]
pub(in crate::contact) struct FeaturesOfCell {
    pub triangles: Range<u32>,
    pub edges: Range<u32>,
    pub particles: Range<u32>,
}

impl FeaturesOfCell {
    /// The features among others, with larger indices of packs.
    pub fn moved(&self, packs: u32) -> Self {
        let moved = |range: &Range<u32>| range.start + packs..range.end + packs;
        Self {
            triangles: moved(&self.triangles),
            edges: moved(&self.edges),
            particles: moved(&self.particles),
        }
    }
}
