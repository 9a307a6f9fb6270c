//! Sums over the triangles at each node of a single net, eight patches at once.
//!
//! The terms of a particle's sum are added in the order of the fabric's patches, so that it has the bits of scalar code.

use fearless_simd::{Simd, SimdBase, f32x4};

use super::vectors::{pack_count, write_vectors};
use crate::fabric::Patch;
use crate::geometry::corners::{Contribution, CornerSums, Corners};
use crate::simd::lane::{Lane, Pack};
use crate::simd::level::dispatch;
use crate::simd::registers::{Pack4, Pack8};
use crate::simd::vec3::{Pack3, V3};

/// The number of each lane.
const LANES: [u32; Pack8::WIDTH] = [0, 1, 2, 3, 4, 5, 6, 7];

/// The patches of a mesh, in packs.
#[derive(Clone, Debug)]
pub(crate) struct PatchPacks {
    packs: Vec<PatchPack>,
    /// Terms of both triangles, of the first and of the second, of each pack of patches.
    terms: Vec<[[Pack4; Pack8::WIDTH]; 3]>,
    /// The sum of each particle.
    sums: Vec<Pack4>,
}

/// Consecutive patches, one in each lane.
#[derive(Clone, Debug)]
struct PatchPack {
    /// Corners a, b, c and d of each patch.
    corners: [[u32; Pack8::WIDTH]; 4],
    /// As [`Patch::corner_areas`], m².
    corner_areas: [Pack8; 2],
    /// Number of patches. Other lanes repeat one particle.
    count: usize,
}

impl PatchPacks {
    pub fn new(patches: &[Patch], particles: usize) -> Self {
        let packs: Vec<PatchPack> = patches.chunks(Pack8::WIDTH).map(PatchPack::new).collect();
        Self {
            terms: vec![[[Pack4::splat(0.0); Pack8::WIDTH]; 3]; packs.len()],
            packs,
            sums: vec![Pack4::splat(0.0); pack_count(particles) * Pack8::WIDTH],
        }
    }
}

impl PatchPack {
    fn new(patches: &[Patch]) -> Self {
        let mut pack = Self {
            corners: [[patches[0].corners[0]; Pack8::WIDTH]; 4],
            corner_areas: [Pack8::splat(0.0); 2],
            count: patches.len(),
        };
        for (lane, patch) in patches.iter().enumerate() {
            for (corners, &corner) in pack.corners.iter_mut().zip(&patch.corners) {
                corners[lane] = corner;
            }
            for (areas, &area) in pack.corner_areas.iter_mut().zip(&patch.corner_areas) {
                areas.lanes_mut()[lane] = area;
            }
        }
        pack
    }
}

impl<L: Lane<Pack = Pack8>> Corners<L> for &PatchPack {
    type Field = [Pack4];

    #[inline(always)]
    fn load(&self, token: L::Token, field: &[Pack4]) -> [V3<L>; 4] {
        let [a, b, c, d] = &self.corners;
        [
            V3::gather(token, field, a),
            V3::gather(token, field, b),
            V3::gather(token, field, c),
            V3::gather(token, field, d),
        ]
    }

    #[inline(always)]
    fn areas(&self, token: L::Token) -> [L; 2] {
        let [first, second] = &self.corner_areas;
        [L::load(token, first), L::load(token, second)]
    }

    #[inline(always)]
    fn where_present(&self, _: L::Token, vector: V3<L>) -> V3<L> {
        vector
    }
}

impl CornerSums<Pack8> for &mut PatchPacks {
    type Field = [Pack4];

    #[inline(always)]
    fn sum<L: Lane<Pack = Pack8>, T: Contribution<L, [Pack4]>>(
        self,
        token: L::Token,
        contribution: &T,
        sums: &mut [Pack3<Pack8>],
    ) {
        let PatchPacks { packs, terms, sums: vectors } = self;
        for (pack, terms) in packs.iter().zip(&mut *terms) {
            let [first, second] = contribution.of(token, &pack);
            let [to_both, to_first, to_second] = terms;
            (first + second).scatter(token, to_both, &LANES);
            first.scatter(token, to_first, &LANES);
            second.scatter(token, to_second, &LANES);
        }
        dispatch!(set => sum_terms(set, packs, terms, vectors));
        write_vectors(vectors, sums);
        for sum in sums {
            contribution.finish(token, V3::load(token, sum)).store(sum);
        }
    }
}

/// Adds the terms of each patch to the sums of its corners.
#[inline(always)]
fn sum_terms<S: Simd>(
    set: S,
    packs: &[PatchPack],
    terms: &[[[Pack4; Pack8::WIDTH]; 3]],
    sums: &mut [Pack4],
) {
    sums.fill(Pack4::splat(0.0));
    for (pack, [both, first, second]) in packs.iter().zip(terms) {
        let [a, b, c, d] = &pack.corners;
        for lane in 0..pack.count {
            let both = f32x4::from_slice(set, both[lane].lanes());
            let first = f32x4::from_slice(set, first[lane].lanes());
            let second = f32x4::from_slice(set, second[lane].lanes());
            for (corner, term) in
                [(a[lane], both), (b[lane], first), (c[lane], both), (d[lane], second)]
            {
                let sum = sums[corner as usize].lanes_mut();
                (f32x4::from_slice(set, sum) + term).store_slice(sum);
            }
        }
    }
}
