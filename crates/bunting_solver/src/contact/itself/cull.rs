//! Pairs of features that cannot touch are dropped, eight at a time: boxes around paths meet far more often than paths.
//!
//! What is left is a little more than the contacts, so that pairs stay good while particles move a little.

use glam::Vec3;

use crate::constants::{LEAST_AREA_SQUARED, LEAST_LENGTH};
use crate::contact::itself::near::Kind;
use crate::contact::itself::pairs::Pairs;
use crate::contact::itself::particles::Particles;
use crate::contact::itself::separate::FAR;
use crate::simd::lane::{Kernel, Lane, Mask, Pack};
use crate::simd::registers::Pack8;
use crate::simd::vec3::{Pack3, V3};

/// How far beside a triangle a particle may be, as a part of the triangle's height.
const BESIDE: f32 = 0.05;

/// Drops the pairs that stay farther apart than twice the distance that they keep, m, and that do not pass through each
/// other.
pub(in crate::contact) fn drop_distant(pairs: &mut Pairs, particles: &Particles, thickness: f32) {
    let positions = [&particles.start[..], &particles.end[..]];
    let far = FAR * thickness;
    let Pairs { particles_triangles, edges_edges, .. } = pairs;
    let kind = Kind::ParticleTriangle;
    Pack8::run(Drop { kind, pairs: particles_triangles, positions, far });
    let kind = Kind::EdgeEdge;
    Pack8::run(Drop { kind, pairs: edges_edges, positions, far });
}

struct Drop<'a> {
    kind: Kind,
    pairs: &'a mut Vec<[u32; 4]>,
    /// Positions of all particles at the start and at the end of the substep, m.
    positions: [&'a [Vec3]; 2],
    far: f32,
}

impl Kernel<Pack8> for Drop<'_> {
    #[inline(always)]
    fn run<L: Lane<Pack = Pack8>>(self, token: L::Token) {
        let Self { kind, pairs, positions, far } = self;
        let [zero, one] = [L::splat(token, 0.0), L::splat(token, 1.0)];
        let far = L::splat(token, far);
        let (mut kept, mut first) = (0, 0);
        while first < pairs.len() {
            let count = (pairs.len() - first).min(Pack8::WIDTH);
            let start = gather::<L>(token, &pairs[first..first + count], positions[0]);
            let end = gather::<L>(token, &pairs[first..first + count], positions[1]);
            let touch = match kind {
                Kind::ParticleTriangle => touch_triangles(token, &start, &end, far),
                Kind::EdgeEdge => touch_edges(token, &start, &end, far),
            };
            if touch.any() {
                let mut lanes = Pack8::splat(0.0);
                one.or_where_not(touch, zero).store(&mut lanes);
                for lane in 0..count {
                    if lanes.lanes()[lane] != 0.0 {
                        pairs[kept] = pairs[first + lane];
                        kept += 1;
                    }
                }
            }
            first += count;
        }
        pairs.truncate(kept);
    }
}

/// The four particles of up to eight pairs; the last pair in the lanes without one.
#[inline(always)]
fn gather<L: Lane<Pack = Pack8>>(
    token: L::Token,
    pairs: &[[u32; 4]],
    positions: &[Vec3],
) -> [V3<L>; 4] {
    let mut packs: [Pack3<Pack8>; 4] = [[Pack8::splat(0.0); 3]; 4];
    for lane in 0..Pack8::WIDTH {
        let pair = &pairs[lane.min(pairs.len() - 1)];
        for (pack, &particle) in packs.iter_mut().zip(pair) {
            let at = positions[particle as usize];
            pack[0].lanes_mut()[lane] = at.x;
            pack[1].lanes_mut()[lane] = at.y;
            pack[2].lanes_mut()[lane] = at.z;
        }
    }
    [
        V3::load(token, &packs[0]),
        V3::load(token, &packs[1]),
        V3::load(token, &packs[2]),
        V3::load(token, &packs[3]),
    ]
}

/// Whether particles are near the triangles that they face at the end, or have changed sides.
#[inline(always)]
fn touch_triangles<L: Lane>(
    token: L::Token,
    start: &[V3<L>; 4],
    end: &[V3<L>; 4],
    far: L,
) -> L::Mask {
    let beside = L::splat(token, -BESIDE);
    let [particle, a, b, c] = *end;
    let (first, second, from) = (b - a, c - a, particle - a);
    let normal = first.cross(second);
    let squared_area = normal.dot(normal).max(L::splat(token, LEAST_AREA_SQUARED));
    let of_c = first.cross(from).dot(normal);
    let of_b = from.cross(second).dot(normal);
    let of_a = squared_area - of_b - of_c;
    let is_over = (beside * squared_area).lt(of_a.min(of_b).min(of_c));
    let height = from.dot(normal);
    let is_near = (height * height).lt(far * far * squared_area);
    let before = start[0] - start[1];
    let before = before.dot((start[2] - start[1]).cross(start[3] - start[1]));
    (is_over & is_near) | (before * height).lt(L::splat(token, 0.0))
}

/// Whether edges are near each other at the end, or have passed through each other's lines.
#[inline(always)]
fn touch_edges<L: Lane>(token: L::Token, start: &[V3<L>; 4], end: &[V3<L>; 4], far: L) -> L::Mask {
    let [zero, unit] = [L::splat(token, 0.0), L::splat(token, 1.0)];
    let [a, b, c, d] = *end;
    let (one, other, between) = (b - a, d - c, a - c);
    let least = L::splat(token, LEAST_LENGTH);
    let squared_one = one.dot(one).max(least);
    let squared_other = other.dot(other).max(least);
    let (along_one, along_other) = (one.dot(between), other.dot(between));
    let both = one.dot(other);
    let determinant = (squared_one * squared_other - both * both).max(least * least);
    // The closest points of lines, then of edges (Ericson 2005, 5.1.9).
    let first = (both * along_other - along_one * squared_other) / determinant;
    let first = first.max(zero).min(unit);
    let second = ((both * first + along_other) / squared_other).max(zero).min(unit);
    let first = ((both * second - along_one) / squared_one).max(zero).min(unit);
    let away = between + one * first - other * second;
    let is_near = away.dot(away).lt(far * far);
    let volume = one.cross(other).dot(between);
    let before = (start[1] - start[0]).cross(start[3] - start[2]).dot(start[0] - start[2]);
    is_near | (before * volume).lt(zero)
}

#[cfg(test)]
mod tests {
    use super::*;

    const THICKNESS: f32 = 0.05;

    /// A number from −0.5 to 0.5.
    fn noise(index: usize) -> f32 {
        let mixed = (index as u32 + 1).wrapping_mul(2_654_435_769);
        let mixed = (mixed ^ (mixed >> 15)).wrapping_mul(2_246_822_519);
        (mixed >> 8) as f32 / (1 << 24) as f32 - 0.5
    }

    #[test]
    fn pairs_that_touch_are_kept_and_most_that_do_not_are_dropped() {
        const COUNT: usize = 4001;
        let at =
            |index: usize| Vec3::new(noise(index), noise(index + 50_000), noise(index + 90_000));
        let start: Vec<Vec3> = (0..4 * COUNT).map(at).collect();
        let moved = |(index, &at): (usize, &Vec3)| at + 0.1 * Vec3::splat(noise(index + 7));
        let end: Vec<Vec3> = start.iter().enumerate().map(moved).collect();
        let pairs: Vec<[u32; 4]> =
            (0..COUNT as u32).map(|it| [4 * it, 4 * it + 1, 4 * it + 2, 4 * it + 3]).collect();
        let particles = Particles { start, end, ..Particles::default() };
        let mut left = Pairs {
            particles_triangles: pairs.clone(),
            edges_edges: pairs.clone(),
            edges_triangles: Vec::new(),
        };
        drop_distant(&mut left, &particles, THICKNESS);
        let kinds = [
            (Kind::ParticleTriangle, &left.particles_triangles),
            (Kind::EdgeEdge, &left.edges_edges),
        ];
        for (kind, left) in kinds {
            let mut touching = 0;
            for pair in &pairs {
                let of = |all: &[Vec3]| pair.map(|particle| all[particle as usize]);
                let (start, end) = (of(&particles.start), of(&particles.end));
                let passed = kind.passed(start, end);
                let near = kind.near(end, passed);
                if near.is_some_and(|near| near.gap < FAR * THICKNESS) {
                    touching += 1;
                    assert!(left.contains(pair), "{kind:?}: {pair:?}");
                }
            }
            let kept = left.len();
            assert!(
                touching > 100 && kept < 3 * touching,
                "{kind:?}: {kept} kept, {touching} touch"
            );
        }
    }
}
