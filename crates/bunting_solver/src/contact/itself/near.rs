//! How two features face each other, and whether they have passed through each other.

use glam::Vec3;

use crate::constants::LEAST_LENGTH;
use crate::contact::itself::closest::{edges, over};

/// Which features touch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::contact) enum Kind {
    /// A particle and the corners of a triangle.
    ParticleTriangle,
    /// The ends of one edge and those of another.
    EdgeEdge,
}

/// Two features that face each other.
pub(in crate::contact) struct Near {
    /// Unit normal, to the side of the positive factors.
    pub normal: Vec3,
    pub factors: [f32; 4],
    /// Signed distance, m.
    pub gap: f32,
}

impl Kind {
    /// The features at given positions, m, where they face each other; `passed` is the side on which they belong if they
    /// have passed through each other, else zero.
    pub fn near(self, at: [Vec3; 4], passed: f32) -> Option<Near> {
        match self {
            Self::ParticleTriangle => over_triangle(at, passed),
            Self::EdgeEdge => between_edges(at, passed),
        }
    }

    /// Distance of the features at given positions, m; infinite where they do not face each other.
    pub fn distance(self, at: [Vec3; 4]) -> f32 {
        match self {
            Self::ParticleTriangle => height_or_far(at),
            Self::EdgeEdge => distance_of_edges(at),
        }
    }

    /// Whether the features may be nearer than a distance, m: unless two of their particles are farther apart than the
    /// features reach.
    pub fn are_within(self, [a, b, c, d]: &[Vec3; 4], distance: f32) -> bool {
        let (apart, reach) = match self {
            Self::ParticleTriangle => (a.distance(*b), b.distance(*c).max(b.distance(*d))),
            Self::EdgeEdge => (a.distance(*c), a.distance(*b) + c.distance(*d)),
        };
        apart <= reach + distance
    }

    /// The sign of the height, or of the volume, at the start if the features have passed through each other since; else
    /// zero.
    pub fn passed(self, start: [Vec3; 4], end: [Vec3; 4]) -> f32 {
        match self {
            Self::ParticleTriangle => passed_triangle(start, end),
            Self::EdgeEdge => passed_edge(start, end),
        }
    }
}

/// Height of a particle over a triangle if it is projected into the triangle, m; else infinite.
fn height_or_far([particle, a, b, c]: [Vec3; 4]) -> f32 {
    match over(particle, [a, b, c]) {
        Some(over) if over.is_inside() => over.height.abs(),
        _ => f32::INFINITY,
    }
}

/// Distance of two edges, m.
fn distance_of_edges([a, b, c, d]: [Vec3; 4]) -> f32 {
    let [first, second] = edges([a, b], [c, d]);
    a.lerp(b, first).distance(c.lerp(d, second))
}

/// The sign of a particle's height over a triangle at the start if it has passed through the triangle; else zero.
fn passed_triangle(start: [Vec3; 4], end: [Vec3; 4]) -> f32 {
    let height = |[particle, a, b, c]: [Vec3; 4]| Some(over(particle, [a, b, c])?.height);
    let (Some(from), Some(to)) = (height(start), height(end)) else { return 0.0 };
    if from * to >= 0.0 {
        return 0.0;
    }
    let time = from / (from - to);
    let [particle, a, b, c] = core::array::from_fn(|at| start[at].lerp(end[at], time));
    match over(particle, [a, b, c]) {
        Some(over) if over.is_inside() => from.signum(),
        _ => 0.0,
    }
}

/// The sign of two edges' volume at the start if they have passed through each other; else zero.
fn passed_edge(start: [Vec3; 4], end: [Vec3; 4]) -> f32 {
    let (from, to) = (volume(start), volume(end));
    if from * to >= 0.0 {
        return 0.0;
    }
    let time = from / (from - to);
    let [a, b, c, d] = core::array::from_fn(|at| start[at].lerp(end[at], time));
    let inside = edges([a, b], [c, d]).into_iter().all(|it| it > 0.0 && it < 1.0);
    /// Part of the edges' length within which they meet at that time, which is an estimate.
    const MEETING: f32 = 0.1;
    let length = a.distance(b).min(c.distance(d));
    let meet = distance_of_edges([a, b, c, d]) < MEETING * length;
    if inside && meet { from.signum() } else { 0.0 }
}

/// Six times the volume between two edges, m³.
fn volume([a, b, c, d]: [Vec3; 4]) -> f32 {
    (b - a).cross(d - c).dot(a - c)
}

/// A particle over a triangle; none beside it.
fn over_triangle([particle, a, b, c]: [Vec3; 4], passed: f32) -> Option<Near> {
    let over = over(particle, [a, b, c]).filter(|over| over.is_inside())?;
    let side = if passed == 0.0 { over.height.signum() } else { passed };
    let [of_a, of_b, of_c] = over.coordinates;
    Some(Near {
        normal: over.normal * side,
        factors: [1.0, -of_a, -of_b, -of_c],
        gap: over.height * side,
    })
}

/// Two edges that face each other; none where they have passed through each other and do not face each other.
fn between_edges([a, b, c, d]: [Vec3; 4], passed: f32) -> Option<Near> {
    let [first, second] = edges([a, b], [c, d]);
    let away = a.lerp(b, first) - c.lerp(d, second);
    let distance = away.length();
    let factors = [1.0 - first, first, second - 1.0, -second];
    if passed != 0.0 {
        let is_inside = [first, second].iter().all(|&it| it > 0.0 && it < 1.0);
        let normal = (b - a).cross(d - c).try_normalize().filter(|_| is_inside)? * passed;
        return Some(Near { normal, factors, gap: away.dot(normal) });
    }
    if distance < LEAST_LENGTH {
        return None;
    }
    Some(Near { normal: away / distance, factors, gap: distance })
}
