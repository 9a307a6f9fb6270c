//! Contacts between triangles of cloth and a shape: features of the shape that pass between particles.
//!
//! All vectors are in the shape's frame, at the beginning or at the end of the substep, so the shape rests.

use glam::Vec3;

use crate::constants::LEAST_LENGTH;
use crate::contact::obstacle::{Cut, Obstacle, barycentric};
use crate::contact::plane::Plane;
use crate::contact::touch::Touch;

/// Number of sweeps in each solve: the first over all triangles, the others over those of which a corner has moved since.
/// Fewer: triangles that several features cut are left cut, and those beside an overtaken one are lost.
const SWEEPS: usize = 4;

/// Greatest number of steps in the search for the time at which a triangle meets a shape. Fewer: fast shapes that
/// graze a triangle go through.
const ADVANCES: usize = 16;

/// Part of the estimated distance by which the search advances; the estimate is too large where the deepest point was
/// missed. Larger: edges of fast boxes go through.
const ADVANCE: f32 = 0.7;

/// Depth at the end of a substep from which on a triangle that a shape has met counts as overtaken, and moves with the
/// shape, m. Smaller: cloth that falls on a shape sticks. Larger: the corners beside a fast small ball are thrown ahead
/// of it.
const OVERTAKEN: f32 = 5e-3;

/// Depth at the start of a substep from which on a triangle is left to its particles, as a fraction of its longest side: the
/// cloth has begun in the shape, so that neither side is the right one. Smaller: features of shapes that a change of level
/// leaves in the cloth go through. Larger: cloth that a shape pierces is torn to both sides without an end.
const PIERCED: f32 = 0.5;

/// A corner of triangles near a shape.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    /// Inverse mass, zero if pinned.
    pub inverse_mass: f32,
    /// Position at the start of the substep, m.
    pub from: Vec3,
    /// Present position, m.
    pub to: Vec3,
    /// The contact that has moved the corner farthest along its normal; it sticks if any has.
    pub touch: Option<Touch>,
    /// How far that contact has moved the corner along its normal, m.
    depth: f32,
    /// The plane nearest to the present position, if it has been computed.
    plane: Option<Plane>,
    /// The last sweep that may have moved the corner, counted from one; zero if none has.
    moved: usize,
}

impl Corner {
    pub fn new(inverse_mass: f32, from: Vec3, to: Vec3) -> Self {
        Self { inverse_mass, from, to, touch: None, depth: 0.0, plane: None, moved: 0 }
    }

    /// Moves the corner. Of several contacts the deepest one gives the normal. The last one pushes a ball on a sheet to one
    /// side, since the triangles around a corner are always solved in the same order; a mean lets thin shapes through, since
    /// it points anywhere between their opposite sides.
    fn put(&mut self, to: Vec3, touch: Touch) {
        let depth = (to - self.to).dot(touch.normal);
        let deepest = match self.touch {
            Some(former) if depth <= self.depth => former,
            _ => {
                self.depth = depth;
                touch
            }
        };
        let sticks = touch.sticks || self.touch.is_some_and(|former| former.sticks);
        self.touch = Some(Touch { sticks, ..deepest });
        self.to = to;
        self.plane = None;
    }
}

/// Moves corners until no triangle is nearer to the obstacle than permitted. `triangles` have indices of corners.
pub(super) fn solve_triangles(
    obstacle: &Obstacle,
    friction: f32,
    triangles: &[[u32; 3]],
    corners: &mut [Corner],
) {
    for sweep in 0..SWEEPS {
        let mut any = false;
        for triangle in triangles {
            let particles = triangle.map(|corner| corner as usize);
            let is_due = particles.iter().any(|&at| corners[at].moved >= sweep);
            if is_due && solve_triangle(obstacle, friction, particles, corners) {
                any = true;
                particles.into_iter().for_each(|at| corners[at].moved = sweep + 1);
            }
        }
        if !any {
            return;
        }
    }
    hold_back(obstacle, triangles, corners);
}

/// Returns the corners of triangles that would still pass through the shape to where they began the substep, until no
/// triangle does. Each corner returns at most once, so this ends.
fn hold_back(obstacle: &Obstacle, triangles: &[[u32; 3]], corners: &mut [Corner]) {
    for round in SWEEPS.. {
        let mut any = false;
        for triangle in triangles {
            let particles = triangle.map(|corner| corner as usize);
            if !particles.iter().any(|&at| corners[at].moved >= round) {
                continue;
            }
            let Some(Meeting::Overtaken { touch, .. }) = meet(obstacle, particles, corners) else {
                continue;
            };
            for at in particles {
                let corner = &mut corners[at];
                if corner.inverse_mass > 0.0 && corner.to != corner.from {
                    corner.put(corner.from, touch);
                    corner.moved = round + 1;
                    any = true;
                }
            }
        }
        if !any {
            return;
        }
    }
}

/// How a triangle meets a shape in a substep.
enum Meeting {
    /// The shape overtakes the triangle after a fraction `at` of the substep.
    Overtaken { at: f32, touch: Touch },
    /// A point of the triangle is too close at the end.
    Cut(Cut),
}

/// Finds how a triangle meets a shape; none if it does not.
fn meet(obstacle: &Obstacle, particles: [usize; 3], corners: &mut [Corner]) -> Option<Meeting> {
    let (from, to) = (particles.map(|at| corners[at].from), particles.map(|at| corners[at].to));
    if obstacle.is_beside(&[from[0], from[1], from[2], to[0], to[1], to[2]]) {
        return None;
    }
    let displacements = from.iter().zip(&to).map(|(from, to)| from.distance(*to));
    let greatest = displacements.fold(0.0, f32::max);
    let is_fast = greatest > obstacle.ccd_threshold;
    let hit = if is_fast { first_hit(obstacle, &from, &to, greatest) } else { None };
    let is_above = is_above(obstacle, particles, &to, corners);
    let end = if is_above { None } else { obstacle.deepest_cut(&to) };
    if (hit.is_some() || end.is_some()) && is_pierced(obstacle, &from) {
        return None;
    }
    if let Some((at, hit)) = &hit
        && hit.depth.max(end.as_ref().map_or(0.0, |end| end.depth)) > OVERTAKEN
    {
        let met = weighted(&hit.weights, &between(&from, &to, *at));
        let touch = Touch { normal: hit.normal, at: met, sticks: true };
        return Some(Meeting::Overtaken { at: *at, touch });
    }
    end.or(hit.map(|(_, hit)| hit)).map(Meeting::Cut)
}

/// Whether a part of a triangle is so deep in the shape that the shape pierces it.
fn is_pierced(obstacle: &Obstacle, corners: &[Vec3; 3]) -> bool {
    let [a, b, c] = *corners;
    let longest = (b - a).length().max((c - b).length()).max((a - c).length());
    let deep = -PIERCED * longest;
    obstacle.deepest(corners, deep).is_some_and(|(_, plane)| plane.distance < deep)
}

/// Moves the corners of one triangle. Returns whether they had to move.
fn solve_triangle(
    obstacle: &Obstacle,
    friction: f32,
    particles: [usize; 3],
    corners: &mut [Corner],
) -> bool {
    match meet(obstacle, particles, corners) {
        None => false,
        Some(Meeting::Cut(cut)) => push_out(&cut, friction, particles, corners),
        Some(Meeting::Overtaken { at, touch }) => {
            particles.map(|corner| stop(&mut corners[corner], at, touch)).contains(&true)
        }
    }
}

/// Moves a corner of an overtaken triangle to where it was when the shape met the triangle, in the shape's frame, unless
/// it has gone farther out since. Returns whether it had to move.
fn stop(corner: &mut Corner, at: f32, touch: Touch) -> bool {
    let met = corner.from.lerp(corner.to, at);
    let goes_in = corner.inverse_mass > 0.0 && (met - corner.to).dot(touch.normal) > 0.0;
    if goes_in {
        corner.put(met, touch);
    }
    goes_in
}

/// Moves a point of a triangle out of the shape, with friction. Returns whether its corners can move.
fn push_out(cut: &Cut, friction: f32, particles: [usize; 3], corners: &mut [Corner]) -> bool {
    let Cut { weights, normal, depth } = *cut;
    let (from, to) = (particles.map(|at| corners[at].from), particles.map(|at| corners[at].to));
    let point = weighted(&weights, &to);
    let moved = point - weighted(&weights, &from);
    let slide = moved - normal * moved.dot(normal);
    // Friction shortens the slide by at most its coefficient times the depth (Coulomb's cone).
    let held = (friction * depth / slide.length().max(LEAST_LENGTH)).min(1.0);
    let shift = normal * depth - slide * held;
    let inverse_masses = particles.map(|corner| corners[corner].inverse_mass);
    let Some(parts) = cut.corner_shifts(inverse_masses) else { return false };
    let touch = Touch { normal, at: point + shift, sticks: false };
    for (corner, part) in particles.into_iter().zip(parts) {
        if part > 0.0 {
            let to = corners[corner].to + shift * part;
            corners[corner].put(to, touch);
        }
    }
    true
}

/// Whether a plane nearest to one of the corners shows that nothing cuts. Where parts of the shape may be smaller than the
/// triangle, the points of the surface nearest to all corners and to the middle must lie below that plane, as they do
/// where the surface is convex.
fn is_above(
    obstacle: &Obstacle,
    particles: [usize; 3],
    to: &[Vec3; 3],
    corners: &mut [Corner],
) -> bool {
    let mut plane_of = |corner: usize| {
        let corner = &mut corners[corner];
        corner.plane = corner.plane.or_else(|| obstacle.nearest_plane(corner.to));
        corner.plane
    };
    let separates = |plane: &Plane| plane.least_height(to) >= obstacle.kept;
    if obstacle.planes_separate {
        return particles.into_iter().any(|at| plane_of(at).is_some_and(|plane| separates(&plane)));
    }
    let [a, b, c] = particles.map(plane_of);
    let is_far = |(corner, plane): (&Vec3, &Option<Plane>)| {
        plane.is_some_and(|plane| obstacle.least_distance(*corner, &plane, to) >= obstacle.kept)
    };
    if to.iter().zip(&[a, b, c]).any(is_far) {
        return true;
    }
    let middle = (to[0] + to[1] + to[2]) / 3.0;
    let points = [to[0], to[1], to[2], middle];
    let planes = [a, b, c, obstacle.nearest_plane(middle)];
    let near = |plane: &Plane| {
        let below = |(at, other): (&Vec3, &Option<Plane>)| {
            other.is_some_and(|other| {
                let foot = *at - other.normal * other.distance;
                plane.height(foot) < 0.5 * obstacle.kept
            })
        };
        points.iter().zip(&planes).all(below)
    };
    planes.iter().flatten().any(|plane| separates(plane) && near(plane))
}

/// The fraction of the substep after which a triangle first comes too close to the obstacle, and how far it then goes
/// beyond the plane that it met. Found by conservative advancement (Mirtich 1996), given the greatest displacement of a
/// corner, m.
fn first_hit(
    obstacle: &Obstacle,
    from: &[Vec3; 3],
    to: &[Vec3; 3],
    greatest: f32,
) -> Option<(f32, Cut)> {
    let mut at = 0.0;
    for advance in 1..=ADVANCES {
        let now = between(from, to, at);
        let middle = (now[0] + now[1] + now[2]) / 3.0;
        let plane = obstacle.nearest_plane(middle)?;
        let mut free = free_fraction(obstacle, (middle, &plane), &now, (from, to), greatest);
        if free * greatest <= obstacle.kept || advance == ADVANCES {
            let (point, plane) = obstacle.deepest(&now, f32::INFINITY)?;
            let nearer = free_fraction(obstacle, (point, &plane), &now, (from, to), greatest);
            free = free.max(ADVANCE * nearer);
            // Cloth that lies on the shape keeps exactly this distance.
            if free * greatest <= 0.5 * obstacle.kept || advance == ADVANCES {
                let weights = barycentric(&now, point)?;
                let depth = obstacle.kept - plane.height(weighted(&weights, to));
                return (depth > 0.0).then_some((at, Cut { weights, normal: plane.normal, depth }));
            }
        }
        at += free;
        if at >= 1.0 {
            return None;
        }
    }
    None
}

/// A lower bound of the fraction of the substep for which a triangle can go on before it comes too close to the obstacle,
/// given the plane nearest to a point of it. The greatest displacement of a corner is at most the distance; where the plane
/// separates the triangle from a convex shape, each corner's displacement along the plane's normal is at most its height.
fn free_fraction(
    obstacle: &Obstacle,
    (point, plane): (Vec3, &Plane),
    now: &[Vec3; 3],
    (from, to): (&[Vec3; 3], &[Vec3; 3]),
    greatest: f32,
) -> f32 {
    let free = (obstacle.least_distance(point, plane, now) - obstacle.kept) / greatest;
    if !obstacle.is_convex {
        return free;
    }
    let until = now.iter().zip(from.iter().zip(to)).map(|(now, (from, to))| {
        let approach = plane.normal.dot(from - to);
        (plane.height(*now) - obstacle.kept) / approach.max(f32::MIN_POSITIVE)
    });
    free.max(until.fold(f32::INFINITY, f32::min))
}

/// The point of a triangle that has these barycentric coordinates.
fn weighted(weights: &[f32; 3], corners: &[Vec3; 3]) -> Vec3 {
    weights[0] * corners[0] + weights[1] * corners[1] + weights[2] * corners[2]
}

/// The triangle after a fraction of the substep.
fn between(from: &[Vec3; 3], to: &[Vec3; 3], at: f32) -> [Vec3; 3] {
    core::array::from_fn(|corner| from[corner].lerp(to[corner], at))
}

#[cfg(test)]
mod tests {
    use glam::{Quat, Vec3};
    use parry3d::shape::SharedShape;

    use super::{Corner, solve_triangles};
    use crate::contact::collider::Collider;
    use crate::contact::obstacle::Obstacle;

    /// Corners of a triangle that is large compared with the shape, around the origin.
    const LARGE: [Vec3; 3] =
        [Vec3::new(-0.3, -0.2, 0.0), Vec3::new(0.3, -0.2, 0.0), Vec3::new(0.0, 0.4, 0.0)];

    /// The corners after a substep in which they move from one height above the origin to another, m.
    fn pass(shape: SharedShape, from: f32, to: f32, friction: f32) -> [Vec3; 3] {
        let collider = Collider::fixed(shape, Vec3::ZERO, Quat::IDENTITY);
        let mut corners = LARGE.map(|at| Corner::new(1.0, at + from * Vec3::Z, at + to * Vec3::Z));
        solve_triangles(&Obstacle::new(&collider, 2e-3), friction, &[[0, 1, 2]], &mut corners);
        corners.map(|corner| corner.to)
    }

    #[test]
    fn a_shape_between_the_corners_does_not_pass() {
        let plate = SharedShape::cuboid(0.05, 0.05, 1e-3);
        for (shape, top) in [(SharedShape::ball(0.02), 0.02), (plate, 1e-3)] {
            for to in [0.01, -0.01, -1.0] {
                let moved = pass(shape.clone(), 0.3, to, 0.0);
                let lowest = moved.iter().map(|at| at.z).fold(f32::MAX, f32::min);
                assert!(lowest > top && lowest < top.max(to) + 3e-3, "{lowest} m after {to}");
            }
        }
    }

    #[test]
    fn a_triangle_that_begins_deep_inside_comes_out() {
        let ball = Collider::fixed(SharedShape::ball(0.5), Vec3::ZERO, Quat::IDENTITY);
        // Its corners have been put on the surface.
        let mut corners = LARGE.map(|at| Corner::new(1.0, at, 0.502 * at.normalize()));
        solve_triangles(&Obstacle::new(&ball, 2e-3), 0.0, &[[0, 1, 2]], &mut corners);
        let nearest = corners.iter().map(|corner| corner.to.length()).fold(f32::MAX, f32::min);
        assert!(nearest > 0.5, "{nearest}");
    }

    #[test]
    fn triangles_beside_a_shape_stay() {
        let moved = pass(SharedShape::ball(0.02), 0.3, 0.05, 1.0);
        assert_eq!(moved, LARGE.map(|at| at + 0.05 * Vec3::Z));
    }
}
