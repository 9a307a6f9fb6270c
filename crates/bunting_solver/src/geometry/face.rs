//! Normals of two triangles that share an edge.

use crate::simd::lane::Lane;
use crate::simd::vec3::V3;

/// Normals of the triangles (a, b, c) and (a, c, d), m²; their lengths are twice the triangles' areas.
#[inline(always)]
pub(crate) fn face<L: Lane>([a, b, c, d]: [V3<L>; 4]) -> [V3<L>; 2] {
    let (ab, ac, ad) = (b - a, c - a, d - a);
    [ab.cross(ac), ac.cross(ad)]
}
