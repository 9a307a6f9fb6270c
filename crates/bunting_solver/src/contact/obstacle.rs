//! A shape that triangles of cloth do not cut: the shape's surface near a triangle.

use core::array;

use glam::Vec3;
use parry3d::bounding_volume::{Aabb, BoundingVolume};
use parry3d::query::{PointQuery, PointQueryWithLocation};
use parry3d::shape::{HeightField, Shape, TriMeshFlags, Triangle};

use crate::constants::LEAST_LENGTH;
use crate::contact::closed_form::ClosedForm;
use crate::contact::collider::Collider;
use crate::contact::ground;
use crate::contact::nearest::nearest_point;
use crate::contact::plane::Plane;

/// Fraction of the particles' clearance that triangles keep. Smaller: cuts that the search misses are
/// visible. Larger: triangles close to an edge are lifted without need.
const KEPT: f32 = 0.5;

/// Search for the deepest point of a triangle: number of steps; length of the first step, as a fraction of
/// the triangle's longest side; and ratio of each step to the one before. Fewer or shorter steps miss the
/// corners of boxes.
const STEPS: usize = 10;
const FIRST_STEP: f32 = 0.5;
const STEP_FACTOR: f32 = 0.7;

/// Displacement of a triangle's corner in a substep, relative to the shape, above which collision detection is
/// continuous: as a fraction of half the least side of the shape's box, and its least and greatest value, m. Larger: shapes
/// thinner than this go through. Smaller: cloth that moves slowly costs more.
const CCD_THRESHOLD: f32 = 0.2;
const LEAST_CCD_THRESHOLD: f32 = 2e-3;
const GREATEST_CCD_THRESHOLD: f32 = 1e-2;

/// Least inverse mass of a point of a triangle, compared with its corners'. Smaller: a cut beside a pin moves the other
/// corners far away.
const LEAST_RESPONSE: f32 = 0.1;

/// Distance above ground below which a triangle is examined, m. Smaller: ridges between particles are missed.
/// Larger: each query visits more cells.
const GROUND_REACH: f32 = 0.1;

/// A point of a triangle that is nearer to a shape than permitted, and must move.
pub(super) struct Cut {
    /// Barycentric coordinates in the triangle.
    pub weights: [f32; 3],
    /// Unit normal, out of the shape.
    pub normal: Vec3,
    /// Distance by which the point must move out, m.
    pub depth: f32,
}

impl Cut {
    /// Parts of the point's shift by which the corners move, in proportion to their inverse masses and weights; none if
    /// the point is almost pinned.
    pub fn corner_shifts(&self, inverse_masses: [f32; 3]) -> Option<[f32; 3]> {
        let weights = self.weights.iter().zip(inverse_masses);
        let response: f32 = weights.map(|(weight, inverse)| weight * weight * inverse).sum();
        if response <= LEAST_RESPONSE * inverse_masses.into_iter().fold(0.0, f32::max) {
            return None;
        }
        Some(array::from_fn(|corner| self.weights[corner] * inverse_masses[corner] / response))
    }
}

/// A shape that triangles do not cut.
pub(super) struct Obstacle<'a> {
    shape: &'a dyn Shape,
    closed_form: Option<ClosedForm<'a>>,
    /// The shape as ground, if it is a heightfield.
    ground: Option<&'a HeightField>,
    /// Whether a plane of the surface is taken to have the whole shape below it. This is exact for convex shapes. Ground
    /// and compounds have parts that are large compared with a cloth's triangles; meshes may have smaller ones.
    pub planes_separate: bool,
    /// Whether the shape is convex.
    pub is_convex: bool,
    /// Displacement of a triangle's corner in a substep, relative to the shape, above which collision detection is
    /// continuous, m.
    pub ccd_threshold: f32,
    /// Box of all points nearer than [`kept`](Self::kept) to the shape, in the shape's frame.
    bounds: Aabb,
    /// Distance that triangles keep, m.
    pub kept: f32,
}

impl<'a> Obstacle<'a> {
    /// The collider's shape, which cloth of a given thickness (m) does not cut.
    pub fn new(collider: &'a Collider, thickness: f32) -> Self {
        let shape = &*collider.shape.0;
        let bounds = shape.compute_local_aabb();
        let is_one = shape.as_compound().is_none() && shape.as_heightfield().is_none();
        let ccd_threshold = if is_one {
            let by_size = CCD_THRESHOLD * bounds.half_extents().min_element();
            by_size.clamp(LEAST_CCD_THRESHOLD, GREATEST_CCD_THRESHOLD)
        } else {
            LEAST_CCD_THRESHOLD
        };
        let kept = KEPT * collider.clearance(thickness);
        Self {
            shape,
            closed_form: ClosedForm::of(shape),
            ground: collider.shape.as_heightfield(),
            planes_separate: shape.as_trimesh().is_none(),
            is_convex: shape.is_convex(),
            ccd_threshold,
            bounds: bounds.loosened(kept),
            kept,
        }
    }

    /// Whether a shape has an inside, and can cut a triangle whose corners are outside.
    pub fn can_cut(shape: &dyn Shape) -> bool {
        let is_open = |flags: TriMeshFlags| !flags.contains(TriMeshFlags::ORIENTED);
        shape.as_halfspace().is_none()
            && shape.as_polyline().is_none()
            && !shape.as_trimesh().is_some_and(|mesh| is_open(mesh.flags()))
    }

    /// Whether points are all beside or above the whole shape.
    pub fn is_beside(&self, points: &[Vec3]) -> bool {
        let low = points.iter().fold(Vec3::INFINITY, |low, at| low.min(*at));
        let high = points.iter().fold(Vec3::NEG_INFINITY, |high, at| high.max(*at));
        low.cmpgt(self.bounds.maxs).any() || high.cmplt(self.bounds.mins).any()
    }

    /// The plane of the surface nearest to a point; none on the surface itself, and far above ground.
    pub fn nearest_plane(&self, at: Vec3) -> Option<Plane> {
        if let Some(form) = &self.closed_form {
            return form.plane(at);
        }
        let nearest = match self.ground {
            Some(field) => ground::project(field, at, GROUND_REACH)?,
            None => nearest_point(self.shape, at),
        };
        let away = if nearest.is_inside { nearest.point - at } else { at - nearest.point };
        let length = away.length();
        let normal = (length > LEAST_LENGTH).then(|| away / length)?;
        let distance = if nearest.is_inside { -length } else { length };
        Some(Plane { normal, offset: normal.dot(nearest.point), distance })
    }

    /// A lower bound of the distance of a triangle from the shape, m, given the plane nearest to one of the triangle's
    /// points: the distance changes by at most a metre a metre, and a plane of a convex shape has the shape below it.
    pub fn least_distance(&self, at: Vec3, plane: &Plane, corners: &[Vec3; 3]) -> f32 {
        let farthest = corners.iter().map(|corner| corner.distance(at)).fold(0.0, f32::max);
        let by_reach = plane.distance - farthest;
        if self.planes_separate { by_reach.max(plane.least_height(corners)) } else { by_reach }
    }

    /// The point of a triangle that is nearest to the shape or deepest inside, found by steps along the triangle
    /// against the normal of the nearest plane, which is the gradient of the distance (Macklin et al. 2020); none if the
    /// whole triangle is farther away than `within` (m), or if a plane is missing.
    pub fn deepest(&self, corners: &[Vec3; 3], within: f32) -> Option<(Vec3, Plane)> {
        let [a, b, c] = *corners;
        let triangle = Triangle::new(a, b, c);
        let longest = (b - a).length().max((c - b).length()).max((a - c).length());
        let mut at = (a + b + c) / 3.0;
        let mut step = FIRST_STEP * longest;
        let mut deepest: Option<(Vec3, Plane)> = None;
        for _ in 0..STEPS {
            let plane = self.nearest_plane(at)?;
            if self.least_distance(at, &plane, corners) >= within {
                return None;
            }
            if deepest.is_none_or(|(_, deepest)| plane.distance < deepest.distance) {
                deepest = Some((at, plane));
            }
            at = triangle.project_local_point(at - step * plane.normal, true).point;
            step *= STEP_FACTOR;
        }
        deepest
    }

    /// The deepest point of a triangle that is nearer than permitted.
    pub fn deepest_cut(&self, corners: &[Vec3; 3]) -> Option<Cut> {
        let deepest = self.deepest(corners, self.kept);
        let (at, plane) = deepest.filter(|(_, plane)| plane.distance < self.kept)?;
        let weights = barycentric(corners, at)?;
        Some(Cut { weights, normal: plane.normal, depth: self.kept - plane.distance })
    }
}

/// Barycentric coordinates of a point of a triangle.
pub(super) fn barycentric([a, b, c]: &[Vec3; 3], at: Vec3) -> Option<[f32; 3]> {
    let triangle = Triangle::new(*a, *b, *c);
    triangle.project_local_point_and_get_location(at, true).1.barycentric_coordinates()
}
