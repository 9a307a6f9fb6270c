//! Vectors of x, y, z and a fourth number, four or eight of them, and the values of each of their coordinates.

#[cfg(target_arch = "x86_64")]
use fearless_simd::{Avx2, Avx512, Level, SimdInto};
use fearless_simd::{Simd, SimdBase, SimdCombine, SimdSplit, f32x4, f32x8};

use crate::simd::vec3::V3;

/// The four vectors with given coordinates, and zero in the fourth place.
#[inline(always)]
pub(crate) fn vectors<S: Simd>(token: S, [x, y, z]: [f32x4<S>; 3]) -> [f32x4<S>; 4] {
    let zero = <f32x4<S> as SimdBase<S>>::splat(token, 0.0);
    let (xz_low, xz_high) = (x.zip_low(z), x.zip_high(z));
    let (yw_low, yw_high) = (y.zip_low(zero), y.zip_high(zero));
    [
        xz_low.zip_low(yw_low),
        xz_low.zip_high(yw_low),
        xz_high.zip_low(yw_high),
        xz_high.zip_high(yw_high),
    ]
}

/// The coordinates of eight vectors.
#[inline(always)]
pub(crate) fn joined<S: Simd>([a, b, c, d, e, f, g, h]: [f32x4<S>; 8]) -> V3<f32x8<S>> {
    let [ae, bf] = [a.combine(e), b.combine(f)];
    let [cg, dh] = [c.combine(g), d.combine(h)];
    let [ac_low, ac_high] = zip_halves(ae, cg);
    let [bd_low, bd_high] = zip_halves(bf, dh);
    let [x, y] = zip_halves(ac_low, bd_low);
    let [z, _] = zip_halves(ac_high, bd_high);
    V3 { x, y, z }
}

/// The eight vectors of given coordinates.
#[inline(always)]
pub(crate) fn split<S: Simd>(token: S, V3 { x, y, z }: V3<f32x8<S>>) -> [f32x4<S>; 8] {
    let zero = <f32x8<S> as SimdBase<S>>::splat(token, 0.0);
    let [xz_low, xz_high] = zip_halves(x, z);
    let [yw_low, yw_high] = zip_halves(y, zero);
    let [ae, bf] = zip_halves(xz_low, yw_low);
    let [cg, dh] = zip_halves(xz_high, yw_high);
    let ((a, e), (b, f)) = (ae.split(), bf.split());
    let ((c, g), (d, h)) = (cg.split(), dh.split());
    [a, b, c, d, e, f, g, h]
}

/// Interleaves the first two lanes of either half of two vectors, and the last two: two instructions, where each half by itself
/// would take four.
#[inline(always)]
fn zip_halves<S: Simd>(a: f32x8<S>, b: f32x8<S>) -> [f32x8<S>; 2] {
    #[cfg(target_arch = "x86_64")]
    {
        let token = a.simd;
        let zipped = match token.level() {
            Level::Avx2(set) => Some(zip_halves_avx2(set, a.into(), b.into())),
            Level::Avx512(set) => Some(zip_halves_avx512(set, a.into(), b.into())),
            _ => None,
        };
        if let Some([low, high]) = zipped {
            return [low.simd_into(token), high.simd_into(token)];
        }
    }
    let ((a_low, a_high), (b_low, b_high)) = (a.split(), b.split());
    [
        a_low.zip_low(b_low).combine(a_high.zip_low(b_high)),
        a_low.zip_high(b_low).combine(a_high.zip_high(b_high)),
    ]
}

macro_rules! zip_halves_of_set {
    ($name:ident, $set:ident) => {
        #[cfg(target_arch = "x86_64")]
        fearless_simd::kernel!(
            #[inline(always)]
            fn $name(set: $set, a: [f32; 8], b: [f32; 8]) -> [[f32; 8]; 2] {
                use core::arch::x86_64::{__m256, _mm256_unpackhi_ps, _mm256_unpacklo_ps};
                let a: f32x8<$set> = a.simd_into(set);
                let b: f32x8<$set> = b.simd_into(set);
                let (a, b): (__m256, __m256) = (a.into(), b.into());
                let low: f32x8<$set> = _mm256_unpacklo_ps(a, b).simd_into(set);
                let high: f32x8<$set> = _mm256_unpackhi_ps(a, b).simd_into(set);
                [low.into(), high.into()]
            }
        );
    };
}

zip_halves_of_set!(zip_halves_avx2, Avx2);
zip_halves_of_set!(zip_halves_avx512, Avx512);
