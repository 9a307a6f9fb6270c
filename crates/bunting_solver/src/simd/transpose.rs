//! Vectors of x, y, z and a fourth number, four or eight of them, and the values of each of their coordinates.

use fearless_simd::{Simd, SimdBase, SimdCombine, SimdSplit, f32x4, f32x8};

use crate::simd::vec3::V3;

/// The coordinates x, y and z of four vectors.
#[inline(always)]
pub(crate) fn coordinates<S: Simd>([a, b, c, d]: [f32x4<S>; 4]) -> [f32x4<S>; 3] {
    let (ac_low, ac_high) = (a.zip_low(c), a.zip_high(c));
    let (bd_low, bd_high) = (b.zip_low(d), b.zip_high(d));
    [ac_low.zip_low(bd_low), ac_low.zip_high(bd_low), ac_high.zip_low(bd_high)]
}

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
    let (low, high) = (coordinates([a, b, c, d]), coordinates([e, f, g, h]));
    V3 { x: low[0].combine(high[0]), y: low[1].combine(high[1]), z: low[2].combine(high[2]) }
}

/// The eight vectors of given coordinates.
#[inline(always)]
pub(crate) fn split<S: Simd>(token: S, by: V3<f32x8<S>>) -> [f32x4<S>; 8] {
    let ((x, x_high), (y, y_high), (z, z_high)) = (by.x.split(), by.y.split(), by.z.split());
    let [a, b, c, d] = vectors(token, [x, y, z]);
    let [e, f, g, h] = vectors(token, [x_high, y_high, z_high]);
    [a, b, c, d, e, f, g, h]
}
