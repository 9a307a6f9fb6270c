//! Vectors of x, y, z and zero, and the packs of eight vectors each.

use fearless_simd::{Simd, SimdBase, f32x4};
use glam::Vec3;

use crate::batch::layout::OfCloth;
use crate::simd::constant::Constant;
use crate::simd::lane::Pack;
use crate::simd::level::dispatch;
use crate::simd::registers::{Pack4, Pack8};
use crate::simd::transpose::{joined, split};
use crate::simd::vec3::{Pack3, V3, lane3, set_lane3, splat3};

/// Number of packs that hold `count` vectors.
pub(super) fn pack_count(count: usize) -> usize {
    count.div_ceil(Pack8::WIDTH)
}

/// Reads the vectors of packs.
pub(super) fn read_vectors(packs: &[Pack3<Pack8>], into: &mut [Pack4]) {
    dispatch!(token => read_all(token, packs, into));
}

/// Overwrites packs by vectors.
pub(super) fn write_vectors(vectors: &[Pack4], into: &mut [Pack3<Pack8>]) {
    dispatch!(token => write_all(token, vectors, into));
}

#[inline(always)]
fn read_all<S: Simd>(token: S, packs: &[Pack3<Pack8>], into: &mut [Pack4]) {
    let (into, _) = into.as_chunks_mut::<{ Pack8::WIDTH }>();
    for (pack, into) in packs.iter().zip(into) {
        for (vector, into) in split(token, V3::load(token, pack)).into_iter().zip(into) {
            vector.store_slice(into.lanes_mut());
        }
    }
}

#[inline(always)]
fn write_all<S: Simd>(token: S, vectors: &[Pack4], into: &mut [Pack3<Pack8>]) {
    let (vectors, _) = vectors.as_chunks::<{ Pack8::WIDTH }>();
    for (vectors, into) in vectors.iter().zip(into) {
        let mut loaded = [<f32x4<S> as SimdBase<S>>::splat(token, 0.0); Pack8::WIDTH];
        for (loaded, vector) in loaded.iter_mut().zip(vectors) {
            *loaded = f32x4::from_slice(token, vector.lanes());
        }
        joined(loaded).store(into);
    }
}

/// Reads as many vectors as there are particles in packs of consecutive ones.
pub(super) fn read_packs(packs: &[Pack3<Pack8>], count: usize, into: &mut Vec<Vec3>) {
    into.resize(count, Vec3::ZERO);
    for (values, pack) in into.chunks_mut(Pack8::WIDTH).zip(packs) {
        for (lane, value) in values.iter_mut().enumerate() {
            *value = lane3(pack, lane);
        }
    }
}

/// Overwrites packs of consecutive particles of a single cloth.
pub(super) fn write_packs(packs: &mut [Pack3<Pack8>], cloths: &[OfCloth]) {
    for &(_, values) in cloths {
        packs.fill(splat3(Vec3::ZERO));
        for (values, pack) in values.unwrap_or_default().chunks(Pack8::WIDTH).zip(&mut *packs) {
            for (lane, &value) in values.iter().enumerate() {
                set_lane3(pack, lane, value);
            }
        }
    }
}

/// One number of each particle in packs of consecutive ones.
pub(super) fn pack_constants(of_particles: &[f32]) -> Vec<Pack8> {
    let constant = |pack: &[f32]| {
        <Pack8 as Constant<Pack8>>::of(|lane| pack.get(lane).copied().unwrap_or(0.0))
    };
    of_particles.chunks(Pack8::WIDTH).map(constant).collect()
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::{pack_count, read_vectors, write_vectors};
    use crate::simd::lane::Pack;
    use crate::simd::registers::{Pack4, Pack8};
    use crate::simd::vec3::{Pack3, lane3, set_lane3, splat3};

    #[test]
    fn vectors_come_back_from_packs() {
        let mut packs: Vec<Pack3<Pack8>> = vec![splat3(Vec3::ZERO); pack_count(13)];
        assert_eq!(packs.len(), 2);
        for at in 0..16_u8 {
            let vector = Vec3::new(1.0, 100.0, 10_000.0) + f32::from(at);
            set_lane3(&mut packs[usize::from(at) / 8], usize::from(at) % 8, vector);
        }
        let mut vectors = vec![Pack4::splat(7.0); 16];
        read_vectors(&packs, &mut vectors);
        for (at, vector) in vectors.iter().enumerate() {
            let Vec3 { x, y, z } = lane3(&packs[at / 8], at % 8);
            assert_eq!(vector.vector(), [x, y, z, 0.0]);
        }
        let mut written = vec![splat3(Vec3::ZERO); 2];
        write_vectors(&vectors, &mut written);
        let same = |(a, b): (&Pack3<Pack8>, &Pack3<Pack8>)| {
            (0..8).all(|lane| lane3(a, lane) == lane3(b, lane))
        };
        assert!(packs.iter().zip(&written).all(same));
    }
}
