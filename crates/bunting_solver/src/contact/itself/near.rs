//! How two features face each other, and whether they have passed through each other: eight pairs at once.

use glam::Vec3;

use crate::constants::{LEAST_AREA_SQUARED, LEAST_LENGTH};
use crate::contact::itself::closest::{Closest, OnBorder, Over};
use crate::simd::lane::{Lane, Mask};
use crate::simd::vec3::V3;

/// Part of the edges' length within which they meet at the time at which they seem to pass through each other, which is an
/// estimate.
const MEETING: f32 = 0.1;

/// Distance from which on features are no contact, as a multiple of what they keep: other contacts move particles by about
/// the thickness.
pub(in crate::contact) const FAR: f32 = 1.25;

/// Two features that face each other.
pub(in crate::contact) struct Near<L: Lane> {
    /// Unit normal, to the side of the positive factors.
    pub normal: V3<L>,
    pub factors: [L; 4],
    /// Signed distance, m.
    pub gap: L,
    /// Whether the features face each other.
    pub faces: L::Mask,
}

/// Two features of a kind, given by four particles.
pub(in crate::contact) trait Features {
    /// Part of the distance of layers that the features keep.
    const PART: f32;

    /// The features at given positions, m; `passed` is the side on which they belong if they have passed through each other,
    /// else zero.
    fn near<L: Lane>(token: L::Token, at: &[V3<L>; 4], passed: L) -> Near<L>;

    /// The sign of the height, or of the volume, at the start if the features have passed through each other since; else
    /// zero.
    fn passed<L: Lane>(token: L::Token, start: &[V3<L>; 4], end: &[V3<L>; 4]) -> L;

    /// Whether the features may be nearer than a distance, m: unless two of their particles are farther apart than the
    /// features reach.
    fn are_within(at: &[Vec3; 4], distance: f32) -> bool;
}

/// A particle and the corners of a triangle.
pub(in crate::contact) struct ParticleTriangle;

/// The ends of one edge and those of another.
pub(in crate::contact) struct EdgeEdge;

impl Features for ParticleTriangle {
    const PART: f32 = 1.0;

    #[inline(always)]
    fn near<L: Lane>(token: L::Token, at: &[V3<L>; 4], passed: L) -> Near<L> {
        let [zero, one] = [L::splat(token, 0.0), L::splat(token, 1.0)];
        let over = Over::new(token, at);
        let side = one.or_where_not(zero.lt(over.height), -one);
        let side = passed.or_where_not(zero.lt(passed.abs()), side);
        let [of_a, of_b, of_c] = over.coordinates;
        let inside = Near {
            normal: over.normal * side,
            factors: [one, -of_a, -of_b, -of_c],
            gap: over.height * side,
            faces: over.is_inside,
        };
        if over.is_inside.all() {
            return inside;
        }
        // Particles beside all triangles must keep their distance, too: where creases lie on one another.
        let border = OnBorder::new(token, at);
        let distance = border.away.dot(border.away).sqrt();
        let least = L::splat(token, LEAST_LENGTH);
        let [of_a, of_b, of_c] = border.coordinates;
        let is_in = over.is_inside;
        Near {
            normal: inside.normal.or_where_not(is_in, border.away * (one / distance.max(least))),
            factors: [
                one,
                inside.factors[1].or_where_not(is_in, -of_a),
                inside.factors[2].or_where_not(is_in, -of_b),
                inside.factors[3].or_where_not(is_in, -of_c),
            ],
            gap: inside.gap.or_where_not(is_in, distance),
            faces: is_in | (passed.abs().lt(one) & least.lt(distance)),
        }
    }

    #[inline(always)]
    fn passed<L: Lane>(token: L::Token, start: &[V3<L>; 4], end: &[V3<L>; 4]) -> L {
        let zero = L::splat(token, 0.0);
        let (from, to) = (height(token, start), height(token, end));
        let changes = (from * to).lt(zero);
        if !changes.any() {
            return zero;
        }
        let over = Over::new(token, &between(token, start, end, [from, to]));
        sign(token, from).or_where_not(changes & over.is_inside, zero)
    }

    fn are_within([particle, a, b, c]: &[Vec3; 4], distance: f32) -> bool {
        particle.distance(*a) <= a.distance(*b).max(a.distance(*c)) + distance
    }
}

impl Features for EdgeEdge {
    /// Particles that keep the whole distance from triangles keep edges apart where cloth is hardly curved. Larger: edges push one another
    /// where particles and triangles do already, ten times as many contacts. Smaller: creases that lie on one another pass through.
    const PART: f32 = 0.7;

    #[inline(always)]
    fn near<L: Lane>(token: L::Token, at: &[V3<L>; 4], passed: L) -> Near<L> {
        let [zero, one] = [L::splat(token, 0.0), L::splat(token, 1.0)];
        let closest = Closest::new(token, at);
        let [first, second] = closest.along;
        let least = L::splat(token, LEAST_LENGTH);
        let distance = closest.away.dot(closest.away).sqrt();
        let has_passed = zero.lt(passed.abs());
        let across = (at[1] - at[0]).cross(at[3] - at[2]);
        let squared = across.dot(across);
        let scale = passed / squared.max(L::splat(token, LEAST_AREA_SQUARED)).sqrt();
        let returns = closest.is_inside & L::splat(token, LEAST_AREA_SQUARED).lt(squared);
        let normal = closest.away * (one / distance.max(least));
        let normal = (across * scale).or_where_not(has_passed, normal);
        let is_near = closest.is_inside & least.lt(distance);
        let faces = (has_passed & returns) | (passed.abs().lt(one) & is_near);
        Near {
            normal,
            factors: [one - first, first, second - one, -second],
            gap: closest.away.dot(normal),
            faces,
        }
    }

    #[inline(always)]
    fn passed<L: Lane>(token: L::Token, start: &[V3<L>; 4], end: &[V3<L>; 4]) -> L {
        let zero = L::splat(token, 0.0);
        let (from, to) = (volume(start), volume(end));
        let changes = (from * to).lt(zero);
        if !changes.any() {
            return zero;
        }
        let at = between(token, start, end, [from, to]);
        let closest = Closest::new(token, &at);
        let [one, other] = closest.squared_lengths;
        let meeting = L::splat(token, MEETING * MEETING);
        let meet = closest.away.dot(closest.away).lt(meeting * one.min(other));
        sign(token, from).or_where_not(changes & closest.is_inside & meet, zero)
    }

    fn are_within([a, b, c, d]: &[Vec3; 4], distance: f32) -> bool {
        a.distance(*c) <= a.distance(*b) + c.distance(*d) + distance
    }
}

/// The sign of a number that is not zero.
#[inline(always)]
fn sign<L: Lane>(token: L::Token, of: L) -> L {
    let one = L::splat(token, 1.0);
    one.or_where_not(L::splat(token, 0.0).lt(of), -one)
}

/// Positions at the time at which a number changes its sign, if it and they change evenly.
#[inline(always)]
fn between<L: Lane>(
    token: L::Token,
    start: &[V3<L>; 4],
    end: &[V3<L>; 4],
    [from, to]: [L; 2],
) -> [V3<L>; 4] {
    let span = from - to;
    let one = L::splat(token, 1.0);
    // Where the sign does not change, the time is not used.
    let time = from / span.or_where_not(L::splat(token, 0.0).lt(span.abs()), one);
    [
        start[0].plus_scaled(end[0] - start[0], time),
        start[1].plus_scaled(end[1] - start[1], time),
        start[2].plus_scaled(end[2] - start[2], time),
        start[3].plus_scaled(end[3] - start[3], time),
    ]
}

/// Signed height of a particle over the plane of a triangle, m.
#[inline(always)]
fn height<L: Lane>(token: L::Token, [particle, a, b, c]: &[V3<L>; 4]) -> L {
    let normal = (*b - *a).cross(*c - *a);
    let squared = normal.dot(normal).max(L::splat(token, LEAST_AREA_SQUARED));
    (*particle - *a).dot(normal) / squared.sqrt()
}

/// Six times the volume between two edges, m³.
#[inline(always)]
fn volume<L: Lane>([a, b, c, d]: &[V3<L>; 4]) -> L {
    (*b - *a).cross(*d - *c).dot(*a - *c)
}

#[cfg(test)]
mod tests {
    use core::marker::PhantomData;

    use parry3d::math::Pose;
    use parry3d::query::PointQuery;
    use parry3d::query::details::closest_points_segment_segment_with_locations;
    use parry3d::shape::SegmentPointLocation::OnEdge;
    use parry3d::shape::{Segment, Triangle};

    use super::*;
    use crate::simd::lane::{Kernel, Pack};
    use crate::simd::registers::Pack1;
    use crate::simd::vec3::splat3;

    /// How two features face each other that have not passed through each other.
    struct Measure<'a, F> {
        at: &'a [Vec3; 4],
        gap: &'a mut Option<f32>,
        factors: &'a mut [f32; 4],
        kind: PhantomData<F>,
    }

    impl<F: Features> Kernel<Pack1> for Measure<'_, F> {
        fn run<L: Lane<Pack = Pack1>>(self, token: L::Token) {
            let at = self.at.map(|at| V3::load(token, &splat3(at)));
            let near = F::near(token, &at, L::splat(token, 0.0));
            let number = |of: L| {
                let mut pack = Pack1::splat(0.0);
                of.store(&mut pack);
                pack.lanes()[0]
            };
            *self.gap = near.faces.any().then(|| number(near.gap));
            *self.factors = near.factors.map(number);
        }
    }

    fn measured<F: Features>(at: &[Vec3; 4]) -> (Option<f32>, [f32; 4]) {
        let (mut gap, mut factors) = (None, [0.0; 4]);
        let kind = PhantomData::<F>;
        Pack1::run(Measure { at, gap: &mut gap, factors: &mut factors, kind });
        (gap, factors)
    }

    /// Four points in a cube of 1 m.
    fn positions(seed: u32) -> [Vec3; 4] {
        let noise = |at: u32| libm::sinf((12 * seed + at) as f32 * 12.9898).abs() * 43.5 % 1.0;
        [0, 3, 6, 9].map(|at| Vec3::new(noise(at), noise(at + 1), noise(at + 2)))
    }

    #[test]
    fn particles_keep_their_distance_from_the_closest_point_of_a_triangle() {
        let mut beside = 0;
        for seed in 0..500 {
            let at @ [particle, a, b, c] = positions(seed);
            let (gap, factors) = measured::<ParticleTriangle>(&at);
            let exact = Triangle::new(a, b, c).distance_to_local_point(particle, true);
            let gap = gap.expect("features that face each other");
            assert!((gap - exact).abs() < 1e-5, "{gap} m for {exact} m, seed {seed}");
            let of_triangle = &factors[1..];
            assert!((of_triangle.iter().sum::<f32>() + 1.0).abs() < 1e-5, "{factors:?}");
            assert!(of_triangle.iter().all(|factor| *factor < 1e-5), "{factors:?}");
            beside += usize::from(of_triangle.contains(&0.0));
        }
        assert!((100..450).contains(&beside), "{beside} beside triangles");
    }

    #[test]
    fn edges_keep_their_distance_where_both_closest_points_are_between_the_ends() {
        let mut facing = 0;
        for seed in 0..500 {
            let at @ [a, b, c, d] = positions(seed);
            let (one, other) = (Segment::new(a, b), Segment::new(c, d));
            let (first, second) =
                closest_points_segment_segment_with_locations(&Pose::IDENTITY, &one, &other);
            let are_inside = [first, second].iter().all(|it| matches!(it, OnEdge(_)));
            let exact = one.point_at(&first).distance(other.point_at(&second));
            match measured::<EdgeEdge>(&at).0 {
                Some(gap) if are_inside => {
                    assert!((gap - exact).abs() < 1e-4, "{gap} m for {exact} m, seed {seed}");
                    facing += 1;
                }
                gap => assert_eq!(gap.is_some(), are_inside, "seed {seed}"),
            }
        }
        assert!((50..450).contains(&facing), "{facing} face each other");
    }
}
