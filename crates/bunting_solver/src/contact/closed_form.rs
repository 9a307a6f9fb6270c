//! Convex shapes whose nearest plane has a closed form: half-space, ball, capsule, cuboid, cylinder, cone and polyhedron, sharp or rounded.
//!
//! parry computes the same by a call through its table of functions, with less known about the shape; it casts rays at cylinders
//! and cones, and finds what is nearest of polyhedra, by iteration.

use glam::{Vec2, Vec3};
use parry3d::shape::{Cone, ConvexPolyhedron, Cuboid, Cylinder, Shape, TypedShape};

use crate::constants::LEAST_LENGTH;
use crate::contact::plane::Plane;
use crate::contact::polyhedron;

/// Greatest number of steps in the search for the point at which a path enters. Fewer: paths that graze an edge enter beside it.
const ADVANCES: usize = 8;

/// Distance from the surface at which a path has entered, m: less than the rounding of coordinates of ten metres.
const ENTERED: f32 = 1e-6;

/// A convex shape: all points that are at most `radius` away from its core, m.
#[derive(Clone, Copy, Debug)]
pub(super) struct ClosedForm<'a> {
    pub core: Core<'a>,
    pub radius: f32,
}

/// Lengths in m. The axes of cylinders and cones are y.
#[derive(Clone, Copy, Debug)]
pub(super) enum Core<'a> {
    /// All points below the plane through the origin that has this unit normal.
    HalfSpace(Vec3),
    /// The origin.
    Point,
    Segment {
        from: Vec3,
        along: Vec3,
    },
    Cuboid {
        half: Vec3,
    },
    Cylinder {
        half_height: f32,
        radius: f32,
    },
    /// Its tip is at the greatest height.
    Cone {
        half_height: f32,
        radius: f32,
    },
    Polyhedron(&'a ConvexPolyhedron),
}

impl Core<'_> {
    fn cuboid(shape: &Cuboid) -> Self {
        Self::Cuboid { half: shape.half_extents }
    }

    fn cylinder(shape: &Cylinder) -> Self {
        Self::Cylinder { half_height: shape.half_height, radius: shape.radius }
    }

    fn cone(shape: &Cone) -> Self {
        Self::Cone { half_height: shape.half_height, radius: shape.radius }
    }

    /// Distance of a point from the core, m, negative inside, and the unit normal of the nearest plane; none if several planes
    /// are nearest.
    fn nearest(&self, at: Vec3) -> Option<(f32, Vec3)> {
        match *self {
            Self::HalfSpace(normal) => Some((at.dot(normal), normal)),
            Self::Point => away(at),
            Self::Segment { from, along } => {
                let length_squared = along.length_squared().max(f32::MIN_POSITIVE);
                let part = ((at - from).dot(along) / length_squared).clamp(0.0, 1.0);
                away(at - (from + along * part))
            }
            Self::Cuboid { half } => {
                let beyond = at.abs() - half;
                let (distance, normal) = of_corner(beyond)?;
                Some((distance, normal * Vec3::ONE.copysign(at)))
            }
            Self::Cylinder { half_height, radius } => {
                let (height, outward) = profile(at);
                let beyond = Vec3::new(height.x - radius, height.y.abs() - half_height, f32::MIN);
                let (distance, normal) = of_corner(beyond)?;
                let up = normal.y.copysign(height.y);
                Some((distance, normal.x * outward + up * Vec3::Y))
            }
            Self::Cone { half_height, radius } => {
                let (place, outward) = profile(at);
                let tip = Vec2::new(0.0, half_height);
                let (distance, normal) =
                    of_triangle(place - tip, Vec2::new(radius, -2.0 * half_height))?;
                Some((distance, normal.x * outward + normal.y * Vec3::Y))
            }
            Self::Polyhedron(shape) => polyhedron::nearest(shape, at),
        }
    }
}

impl<'a> ClosedForm<'a> {
    /// The closed form of a shape, if it has one.
    pub fn of(shape: &'a dyn Shape) -> Option<Self> {
        let (core, radius) = match shape.as_typed_shape() {
            TypedShape::HalfSpace(shape) => (Core::HalfSpace(shape.normal), 0.0),
            TypedShape::Ball(shape) => (Core::Point, shape.radius),
            TypedShape::Capsule(shape) => {
                let (from, along) = (shape.segment.a, shape.segment.b - shape.segment.a);
                (Core::Segment { from, along }, shape.radius)
            }
            TypedShape::Cuboid(shape) => (Core::cuboid(shape), 0.0),
            TypedShape::RoundCuboid(shape) => {
                (Core::cuboid(&shape.inner_shape), shape.border_radius)
            }
            TypedShape::Cylinder(shape) => (Core::cylinder(shape), 0.0),
            TypedShape::RoundCylinder(shape) => {
                (Core::cylinder(&shape.inner_shape), shape.border_radius)
            }
            TypedShape::Cone(shape) => (Core::cone(shape), 0.0),
            TypedShape::RoundCone(shape) => (Core::cone(&shape.inner_shape), shape.border_radius),
            TypedShape::ConvexPolyhedron(shape) => (Core::Polyhedron(shape), 0.0),
            TypedShape::RoundConvexPolyhedron(shape) => {
                (Core::Polyhedron(&shape.inner_shape), shape.border_radius)
            }
            _ => return None,
        };
        Some(Self { core, radius })
    }

    /// The plane of the surface nearest to a point, m; none if several are, as at the centre of a ball.
    pub fn plane(&self, at: Vec3) -> Option<Plane> {
        let (distance, normal) = self.core.nearest(at)?;
        let distance = distance - self.radius;
        Some(Plane { normal, offset: normal.dot(at) - distance, distance })
    }
}

impl ClosedForm<'_> {
    /// The first point of the surface on a path that begins outside, m, and the unit normal there; none if the path does not enter.
    ///
    /// The shape lies below each of its planes. So the path is free up to the plane nearest to where it is known to be free, and these
    /// steps converge like Newton's.
    pub fn entry(&self, from: Vec3, to: Vec3) -> Option<(Vec3, Vec3)> {
        let mut plane = self.plane(from).filter(|plane| plane.distance > 0.0)?;
        let (mut at, mut part) = (from, 0.0);
        for _ in 0..ADVANCES {
            let approach = plane.normal.dot(from - to);
            if plane.distance < ENTERED {
                break;
            }
            if approach <= 0.0 {
                return None;
            }
            part += plane.distance / approach;
            if part > 1.0 {
                return None;
            }
            at = from.lerp(to, part);
            plane = self.plane(at)?;
        }
        Some((at, plane.normal))
    }
}

/// Length and direction of a vector; none if it has no direction.
fn away(vector: Vec3) -> Option<(f32, Vec3)> {
    let length = vector.length();
    (length > LEAST_LENGTH).then(|| (length, vector / length))
}

/// Distance and normal of a convex corner of three orthogonal faces, given how far a point is beyond each face, m.
fn of_corner(beyond: Vec3) -> Option<(f32, Vec3)> {
    let outside = beyond.max(Vec3::ZERO);
    if let Some(away) = away(outside) {
        return Some(away);
    }
    let deepest = beyond.max_element();
    let is_deepest = beyond.cmpge(Vec3::splat(deepest));
    // Of faces that are equally near, the first one.
    let axis = Vec3::AXES.into_iter().zip(<[bool; 3]>::from(is_deepest)).find(|(_, is)| *is);
    axis.map(|(axis, _)| (deepest, axis))
}

/// Distance from the axis and height of a point, m, and the unit vector away from the axis.
fn profile(at: Vec3) -> (Vec2, Vec3) {
    let across = Vec3::new(at.x, 0.0, at.z);
    // On the axis any direction is as good.
    let (distance, outward) = away(across).unwrap_or((0.0, Vec3::X));
    (Vec2::new(distance, at.y), outward)
}

/// Distance and normal of a triangle's sides in the half plane of a cone's profile: `side` leads from the tip to the rim, m, and
/// the base lies level below the tip. The point is given relative to the tip.
fn of_triangle(at: Vec2, side: Vec2) -> Option<(f32, Vec2)> {
    let slope = Vec2::new(-side.y, side.x).try_normalize()?;
    let (above_slope, above_base) = (at.dot(slope), side.y - at.y);
    if above_slope <= 0.0 && above_base <= 0.0 {
        let is_slope = above_slope >= above_base;
        return Some(if is_slope { (above_slope, slope) } else { (above_base, Vec2::NEG_Y) });
    }
    let along = side * (at.dot(side) / side.length_squared()).clamp(0.0, 1.0);
    let base = Vec2::new(at.x.clamp(0.0, side.x), side.y);
    let feet = [along, base].map(|foot| at - foot);
    let away = if feet[0].length_squared() <= feet[1].length_squared() { feet[0] } else { feet[1] };
    let distance = away.length();
    if distance > LEAST_LENGTH {
        return Some((distance, away / distance));
    }
    Some((distance, if above_slope > above_base { slope } else { Vec2::NEG_Y }))
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use parry3d::shape::{Ball, SharedShape, TypedShape};

    use super::ClosedForm;

    fn shapes() -> [SharedShape; 13] {
        let corners = Ball::new(0.3).to_trimesh(9, 6).0;
        let flat = corners.iter().map(|at| *at * Vec3::new(1.0, 0.4, 0.7)).collect::<Vec<_>>();
        let wedge = [Vec3::ZERO, 0.6 * Vec3::X, 0.3 * Vec3::Y, 0.5 * Vec3::X + 0.5 * Vec3::Z];
        let hull = |points: &[Vec3]| SharedShape::convex_hull(points).expect("a hull");
        let rounded =
            |points: &[Vec3]| SharedShape::round_convex_hull(points, 0.05).expect("a hull");
        [
            SharedShape::halfspace(Vec3::new(0.6, 0.8, 0.0)),
            hull(&flat),
            hull(&wedge),
            rounded(&flat),
            SharedShape::ball(0.3),
            SharedShape::capsule(Vec3::new(-0.2, 0.1, 0.0), Vec3::new(0.3, 0.2, 0.1), 0.15),
            SharedShape::capsule(0.1 * Vec3::X, 0.1 * Vec3::X, 0.2),
            SharedShape::cuboid(0.3, 0.1, 0.2),
            SharedShape::round_cuboid(0.3, 0.1, 0.2, 0.05),
            SharedShape::cylinder(0.2, 0.3),
            SharedShape::round_cylinder(0.2, 0.3, 0.04),
            SharedShape::cone(0.3, 0.2),
            SharedShape::round_cone(0.3, 0.2, 0.03),
        ]
    }

    /// A shape without its border, whose width is returned, too: parry searches the distance of rounded shapes by iteration.
    fn without_border(shape: &SharedShape) -> (SharedShape, f32) {
        match shape.as_typed_shape() {
            TypedShape::RoundCuboid(it) => (SharedShape::new(it.inner_shape), it.border_radius),
            TypedShape::RoundCylinder(it) => (SharedShape::new(it.inner_shape), it.border_radius),
            TypedShape::RoundCone(it) => (SharedShape::new(it.inner_shape), it.border_radius),
            TypedShape::RoundConvexPolyhedron(it) => {
                (SharedShape::new(it.inner_shape.clone()), it.border_radius)
            }
            _ => (shape.clone(), 0.0),
        }
    }

    fn points() -> impl Iterator<Item = Vec3> {
        let number = |index: i32, step: f32| (index as f32 * step).fract() - 0.5;
        let at = move |index| {
            Vec3::new(number(index, 0.618_034), number(index, 0.754_878), number(index, 0.569_84))
        };
        (1..3000).map(at)
    }

    #[test]
    fn distances_are_those_of_parry() {
        for (index, shape) in shapes().iter().enumerate() {
            let form = ClosedForm::of(&*shape.0).expect("a closed form");
            for at in points() {
                let plane = form.plane(at).expect("a plane");
                let (sharp, radius) = without_border(shape);
                let projection = sharp.project_local_point(at, false);
                let sign = if projection.is_inside { -1.0 } else { 1.0 };
                let expected = sign * projection.point.distance(at) - radius;
                assert!(
                    (plane.distance - expected).abs() < 2e-5,
                    "{index}: {at} is {} from the shape, {expected}",
                    plane.distance
                );
                assert!((plane.normal.length() - 1.0).abs() < 1e-5, "{index}: {at}");
                assert!((plane.height(at) - plane.distance).abs() < 1e-5, "{index}: {at}");
                // The nearest point is on the surface.
                let foot = form.plane(at - plane.normal * plane.distance);
                assert!(foot.is_none_or(|foot| foot.distance.abs() < 2e-5), "{index}: {at}");
            }
        }
    }

    #[test]
    fn planes_have_the_whole_shape_below() {
        let ball = Ball::new(1.5).to_trimesh(12, 12).0;
        for (index, shape) in shapes().iter().enumerate().skip(1) {
            let form = ClosedForm::of(&*shape.0).expect("a closed form");
            let surface = ball.iter().map(|at| shape.project_local_point(*at, true).point);
            let surface: Vec<Vec3> = surface.collect();
            for at in points().take(300) {
                let plane = form.plane(at).expect("a plane");
                let highest = surface.iter().map(|point| plane.height(*point)).fold(-1.0, f32::max);
                assert!(plane.distance < 0.0 || highest < 1e-4, "{index}: {at}, {highest}");
            }
        }
    }

    #[test]
    fn paths_enter_where_they_first_touch() {
        for (index, shape) in shapes().iter().enumerate() {
            let form = ClosedForm::of(&*shape.0).expect("a closed form");
            let distance = |at: Vec3| form.plane(at).map_or(-1.0, |plane| plane.distance);
            let (mut entered, mut ends) = (0, points().skip(7));
            for from in points().take(1000) {
                let to = ends.next().expect("an end");
                let along = |part: usize| from.lerp(to, part as f32 / 500.0);
                let Some((at, normal)) = form.entry(from, to) else {
                    let least = (0..=500).map(|part| distance(along(part))).fold(1.0, f32::min);
                    assert!(distance(from) <= 0.0 || least > -1e-4, "{index}: {from} to {to}");
                    continue;
                };
                entered += 1;
                assert!(distance(at) < 1e-4 && normal.is_normalized(), "{index}: {from} to {to}");
                let before =
                    (0..=500).map(along).filter(|it| from.distance(*it) < from.distance(at));
                let least = before.map(distance).fold(1.0, f32::min);
                assert!(least > -1e-4, "{index}: {from} to {to}, {least} before {at}");
            }
            assert!(entered > 50, "{index}: {entered}");
        }
    }

    #[test]
    fn only_places_with_several_nearest_planes_have_none() {
        let (ball, cuboid) = (SharedShape::ball(0.3), SharedShape::cuboid(0.3, 0.1, 0.2));
        let ball = ClosedForm::of(&*ball.0).expect("a closed form");
        assert!(ball.plane(Vec3::ZERO).is_none());
        let cuboid = ClosedForm::of(&*cuboid.0).expect("a closed form");
        let on_the_surface = cuboid.plane(Vec3::new(0.05, 0.1, 0.0)).expect("a plane");
        assert_eq!((on_the_surface.normal, on_the_surface.distance), (Vec3::Y, 0.0));
        assert!(ClosedForm::of(&*SharedShape::triangle(Vec3::X, Vec3::Y, Vec3::Z).0).is_none());
    }
}
