//! One cloth's surface: its triangles between particles, in the cloth's frame.

use bevy_math::{Isometry3d, Vec3};
use bunting_solver::Fabric;
use parry3d::bounding_volume::Aabb;
use parry3d::math::Pose;
use parry3d::query::{PointQuery, Ray, RayCast, intersection_test};
use parry3d::shape::{Shape, Triangle};

use crate::motion::pose::parry_pose;

/// The triangles of a cloth at some positions.
#[derive(Clone, Copy)]
pub(crate) struct Surface<'a> {
    fabric: &'a Fabric,
    /// Positions of the particles, m.
    positions: &'a [Vec3],
}

/// A point on a triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PointOnSurface {
    /// Distance from the origin of the ray, or from the point that it is nearest to, m.
    pub distance: f32,
    /// In the frame, m.
    pub at: Vec3,
    /// Unit normal of the triangle; of a ray's hit towards the ray's origin.
    pub normal: Vec3,
    /// Corners of the triangle.
    pub particles: [u32; 3],
    /// Weights of the corners, whose sum is 1.
    pub weights: [f32; 3],
}

impl<'a> Surface<'a> {
    /// None if the positions are those of another fabric.
    pub fn new(fabric: &'a Fabric, positions: &'a [Vec3]) -> Option<Self> {
        (positions.len() == fabric.particle_count()).then_some(Self { fabric, positions })
    }

    /// The box around all particles; none without particles.
    pub fn bounds(positions: &[Vec3]) -> Option<Aabb> {
        let least = positions.iter().copied().reduce(Vec3::min)?;
        let greatest = positions.iter().copied().reduce(Vec3::max)?;
        Some(Aabb::new(least, greatest))
    }

    fn triangles(&self) -> impl Iterator<Item = ([u32; 3], Triangle)> {
        self.fabric.triangles().iter().map(|&particles| {
            let [a, b, c] = particles.map(|particle| self.positions[particle as usize]);
            (particles, Triangle::new(a, b, c))
        })
    }

    /// The first point where a ray meets the surface within a distance, in lengths of its direction.
    pub fn cast_ray(&self, ray: &Ray, within: f32) -> Option<PointOnSurface> {
        let mut first: Option<(f32, Vec3, [u32; 3], Triangle)> = None;
        for (particles, triangle) in self.triangles() {
            let farthest = first.as_ref().map_or(within, |found| found.0);
            if let Some(hit) = triangle.cast_local_ray_and_get_normal(ray, farthest, false) {
                first = Some((hit.time_of_impact, hit.normal, particles, triangle));
            }
        }
        let (distance, normal, particles, triangle) = first?;
        let at = ray.point_at(distance);
        let weights = weights(at, &triangle);
        Some(PointOnSurface {
            distance,
            at,
            normal: normal.normalize_or_zero(),
            particles,
            weights,
        })
    }

    /// The point of the surface nearest to a point (m) within a distance, m.
    pub fn nearest_point(&self, to: Vec3, within: f32) -> Option<PointOnSurface> {
        let mut nearest: Option<(f32, Vec3, [u32; 3], Triangle)> = None;
        for (particles, triangle) in self.triangles() {
            let at = triangle.project_local_point(to, false).point;
            let distance = at.distance(to);
            if distance <= within && nearest.as_ref().is_none_or(|found| distance < found.0) {
                nearest = Some((distance, at, particles, triangle));
            }
        }
        let (distance, at, particles, triangle) = nearest?;
        let normal = triangle.scaled_normal().normalize_or_zero();
        let weights = weights(at, &triangle);
        Some(PointOnSurface { distance, at, normal, particles, weights })
    }

    /// Whether a shape with a pose in the frame intersects the surface.
    pub fn overlaps(&self, shape: &dyn Shape, pose: Isometry3d) -> bool {
        let pose = parry_pose(pose);
        let bounds = shape.compute_aabb(&pose);
        self.triangles().any(|(_, triangle)| {
            // Of two shapes that parry cannot compare none is found.
            meet(&triangle.local_aabb(), &bounds)
                && intersection_test(&Pose::IDENTITY, &triangle, &pose, shape).unwrap_or(false)
        })
    }
}

/// Whether two boxes have a point in common. False where a number is NaN.
pub(super) fn meet(one: &Aabb, other: &Aabb) -> bool {
    one.mins.cmple(other.maxs).all() && other.mins.cmple(one.maxs).all()
}

/// Weights of a triangle's corners at a point on it; those of its first corner for a triangle without area.
fn weights(at: Vec3, &Triangle { a, b, c }: &Triangle) -> [f32; 3] {
    let normal = (b - a).cross(c - a);
    let whole = normal.length_squared();
    if whole <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let part = |from: Vec3, to: Vec3| (from - at).cross(to - at).dot(normal) / whole;
    [part(b, c), part(c, a), part(a, b)]
}
