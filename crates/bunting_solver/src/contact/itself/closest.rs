//! Closest points of a particle and a triangle, and of two edges: eight pairs at once.

use crate::constants::{LEAST_AREA_SQUARED, LEAST_LENGTH};
use crate::simd::lane::Lane;
use crate::simd::vec3::V3;

/// Squared sine of the angle between two edges from which on they are not parallel. Smaller: rounding errors choose the
/// points. Larger: edges that nearly point along each other are not met at their closest points.
const LEAST_SQUARED_SINE: f32 = 1e-6;

/// Least barycentric coordinate of a point inside a triangle: less than zero, so that rounding leaves no gap between two
/// triangles.
const INSIDE: f32 = -1e-6;

/// A particle over or under a triangle.
pub(in crate::contact) struct Over<L: Lane> {
    /// Unit normal of the triangle.
    pub normal: V3<L>,
    /// Signed distance of the particle from the plane, m.
    pub height: L,
    /// Barycentric coordinates of the particle's projection.
    pub coordinates: [L; 3],
    /// Whether the particle is projected into the triangle, which is not collapsed.
    pub is_inside: L::Mask,
}

/// The point on the border of a triangle that is closest to a particle.
pub(in crate::contact) struct OnBorder<L: Lane> {
    /// Barycentric coordinates of the point.
    pub coordinates: [L; 3],
    /// From the point to the particle, m.
    pub away: V3<L>,
}

impl<L: Lane> OnBorder<L> {
    #[inline(always)]
    pub fn new(token: L::Token, [particle, a, b, c]: &[V3<L>; 4]) -> Self {
        let zero = L::splat(token, 0.0);
        let of_ab = OnEdge::new(token, particle, a, b);
        let of_bc = OnEdge::new(token, particle, b, c);
        let of_ca = OnEdge::new(token, particle, c, a);
        let is_nearer = of_bc.squared.lt(of_ab.squared);
        let squared = of_bc.squared.or_where_not(is_nearer, of_ab.squared);
        let away = of_bc.away.or_where_not(is_nearer, of_ab.away);
        let of_a = zero.or_where_not(is_nearer, of_ab.parts[0]);
        let of_b = of_bc.parts[0].or_where_not(is_nearer, of_ab.parts[1]);
        let of_c = of_bc.parts[1].or_where_not(is_nearer, zero);
        let is_nearer = of_ca.squared.lt(squared);
        Self {
            coordinates: [
                of_ca.parts[1].or_where_not(is_nearer, of_a),
                zero.or_where_not(is_nearer, of_b),
                of_ca.parts[0].or_where_not(is_nearer, of_c),
            ],
            away: of_ca.away.or_where_not(is_nearer, away),
        }
    }
}

/// The point on an edge that is closest to a particle.
struct OnEdge<L: Lane> {
    /// Parts of the first and of the second end in the point, which sum up to one.
    parts: [L; 2],
    /// From the point to the particle, m.
    away: V3<L>,
    /// Squared distance, m².
    squared: L,
}

impl<L: Lane> OnEdge<L> {
    #[inline(always)]
    fn new(token: L::Token, particle: &V3<L>, from: &V3<L>, to: &V3<L>) -> Self {
        let (zero, unit) = (L::splat(token, 0.0), L::splat(token, 1.0));
        let least = L::splat(token, LEAST_LENGTH * LEAST_LENGTH);
        let (along, away) = (*to - *from, *particle - *from);
        let second = (away.dot(along) / along.dot(along).max(least)).max(zero).min(unit);
        let away = away.minus_scaled(along, second);
        Self { parts: [unit - second, second], away, squared: away.dot(away) }
    }
}

impl<L: Lane> Over<L> {
    #[inline(always)]
    pub fn new(token: L::Token, [particle, a, b, c]: &[V3<L>; 4]) -> Self {
        let one = L::splat(token, 1.0);
        let least = L::splat(token, LEAST_AREA_SQUARED);
        let (first, second, from) = (*b - *a, *c - *a, *particle - *a);
        let normal = first.cross(second);
        let squared = normal.dot(normal);
        let inverse = one / squared.max(least);
        let of_c = first.cross(from).dot(normal) * inverse;
        let of_b = from.cross(second).dot(normal) * inverse;
        let of_a = one - of_b - of_c;
        let normal = normal * inverse.sqrt();
        Self {
            normal,
            height: from.dot(normal),
            coordinates: [of_a, of_b, of_c],
            is_inside: L::splat(token, INSIDE).lt(of_a.min(of_b).min(of_c)) & least.lt(squared),
        }
    }
}

/// The closest points of two edges (Ericson 2005, "Real-time collision detection", 5.1.9).
pub(in crate::contact) struct Closest<L: Lane> {
    /// Parameters of the points, from 0 to 1.
    pub along: [L; 2],
    /// From the point of the second edge to that of the first, m.
    pub away: V3<L>,
    pub squared_lengths: [L; 2],
    /// Whether both points are between the ends.
    pub is_inside: L::Mask,
}

impl<L: Lane> Closest<L> {
    #[inline(always)]
    pub fn new(token: L::Token, [a, b, c, d]: &[V3<L>; 4]) -> Self {
        let [zero, unit] = [L::splat(token, 0.0), L::splat(token, 1.0)];
        let (one, other, between) = (*b - *a, *d - *c, *a - *c);
        let least = L::splat(token, LEAST_LENGTH * LEAST_LENGTH);
        let [squared_one, squared_other] = [one.dot(one).max(least), other.dot(other).max(least)];
        let (along_one, along_other) = (one.dot(between), other.dot(between));
        let both = one.dot(other);
        let squares = squared_one * squared_other;
        let determinant = squares - both * both;
        let is_skew = (L::splat(token, LEAST_SQUARED_SINE) * squares).lt(determinant);
        let divisor = determinant.or_where_not(is_skew, unit);
        let first = (both * along_other - along_one * squared_other) / divisor;
        let first = first.max(zero).min(unit).or_where_not(is_skew, L::splat(token, 0.5));
        let second = (both * first + along_other) / squared_other;
        let is_beyond = second.lt(zero) | unit.lt(second);
        let second = second.max(zero).min(unit);
        let nearest = (both * second - along_one) / squared_one;
        let first = nearest.max(zero).min(unit).or_where_not(is_beyond, first);
        let is_inside = zero.lt(first.min(second)) & first.max(second).lt(unit);
        Self {
            along: [first, second],
            away: between.plus_scaled(one, first).minus_scaled(other, second),
            squared_lengths: [squared_one, squared_other],
            is_inside,
        }
    }
}
