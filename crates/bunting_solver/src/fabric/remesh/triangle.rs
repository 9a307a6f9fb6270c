//! Points and angles of a triangle.

use glam::DVec3;

/// The cotangent of the angle at the last corner of a triangle.
pub(super) fn cotangent([one, other, corner]: [DVec3; 3]) -> f64 {
    let (one, other) = (one - corner, other - corner);
    one.dot(other) / one.cross(other).length().max(f64::MIN_POSITIVE)
}

/// Barycentric coordinates of a point in the plane of a triangle; on a triangle without area those of the nearest point of
/// the line of its longest side.
pub(super) fn barycentric(at: DVec3, corners: [DVec3; 3]) -> [f64; 3] {
    let [a, b, c] = corners;
    let normal = (b - a).cross(c - a);
    let squared = normal.length_squared();
    if squared > 0.0 {
        let part = |from: DVec3, to: DVec3| (to - from).cross(at - from).dot(normal) / squared;
        return [part(b, c), part(c, a), part(a, b)];
    }
    let length = |side: usize| corners[side].distance_squared(corners[(side + 1) % 3]);
    let longest =
        (1..3).fold(0, |longest, side| if length(side) > length(longest) { side } else { longest });
    let end = (longest + 1) % 3;
    let mut weights = [0.0; 3];
    weights[end] = part_along(at, corners[longest], corners[end]);
    weights[longest] = 1.0 - weights[end];
    weights
}

/// The part of the way between two points at which the line through both is nearest to a third; zero where both are one.
pub(super) fn part_along(at: DVec3, from: DVec3, to: DVec3) -> f64 {
    (at - from).dot(to - from) / (to - from).length_squared().max(f64::MIN_POSITIVE)
}

/// The point of a triangle nearest to another.
pub(super) fn nearest(at: DVec3, corners: [DVec3; 3]) -> DVec3 {
    of_weights(nearest_weights(at, corners), corners)
}

/// The point of a triangle with some weights of its corners.
fn of_weights(weights: [f64; 3], [a, b, c]: [DVec3; 3]) -> DVec3 {
    a * weights[0] + b * weights[1] + c * weights[2]
}

/// The weights of the corners of a triangle at the point of it nearest to another.
pub(in crate::fabric) fn nearest_weights(at: DVec3, corners: [DVec3; 3]) -> [f64; 3] {
    let weights = barycentric(at, corners);
    if weights.iter().all(|weight| *weight >= 0.0) {
        return weights;
    }
    let on_side = |from: usize| {
        let to = (from + 1) % 3;
        let part = part_along(at, corners[from], corners[to]).clamp(0.0, 1.0);
        let mut weights = [0.0; 3];
        (weights[from], weights[to]) = (1.0 - part, part);
        weights
    };
    let away = |weights: &[f64; 3]| of_weights(*weights, corners).distance_squared(at);
    let nearer =
        |one: [f64; 3], other: [f64; 3]| if away(&other) < away(&one) { other } else { one };
    nearer(nearer(on_side(0), on_side(1)), on_side(2))
}
