//! Lifts displayed triangles out of shapes: particles keep their clearance, but a triangle between them can cut
//! a sharp edge.

use glam::{Quat, Vec3};
use parry3d::bounding_volume::{Aabb, BoundingVolume};
use parry3d::query::{PointQuery, PointQueryWithLocation};
use parry3d::shape::{HeightField, Shape, Triangle};

use crate::constants::{LEAST_CLEARANCE, LEAST_LENGTH};
use crate::contact::collider::Collider;
use crate::contact::ground;
use crate::fabric::Fabric;

/// Fraction of the particles' clearance that triangles keep. Smaller: cuts that the search misses are
/// visible. Larger: triangles close to an edge are lifted without need.
const KEPT: f32 = 0.5;

/// Number of sweeps over the triangles. Fewer: a triangle that is cut in two places remains cut in one.
const SWEEPS: usize = 3;

/// Search for the deepest point of a triangle: number of steps; length of the first step, as a fraction of
/// the triangle's longest side; and ratio of each step to the one before. Fewer or shorter steps miss the
/// corners of boxes.
const STEPS: usize = 10;
const FIRST_STEP: f32 = 0.5;
const STEP_FACTOR: f32 = 0.7;

/// Least sum of squared weights of the corners that a cut may move. Smaller: a cut beside a pin moves the
/// other corners far away.
const LEAST_WEIGHT: f32 = 0.1;

/// Distance above ground below which a triangle is examined, m. Smaller: ridges between particles are missed.
/// Larger: each query visits more cells.
const GROUND_REACH: f32 = 0.1;

/// Computes displacements of a displayed cloth's particles that lift its triangles out of colliders. Its
/// buffers are kept from one cloth to the next.
///
/// Meshes of triangles have no inside and are skipped.
#[derive(Clone, Debug, Default)]
pub struct SurfaceLift {
    /// Positions in the frame of the present collider, m.
    positions: Vec<Vec3>,
    /// Plane of the present collider nearest to each particle, if it has been computed.
    planes: Vec<Option<Plane>>,
    /// Displacements so far, in the cloth's frame, m.
    lifts: Vec<Vec3>,
}

impl SurfaceLift {
    /// Writes the particles to be displaced, and their displacements (m), into `into`. `positions` are those
    /// of a fabric's particles in the cloth's frame, m. Colliders have their poses at the end of the tick.
    pub fn compute<'a>(
        &mut self,
        fabric: &Fabric,
        positions: &[Vec3],
        thickness: f32,
        colliders: impl IntoIterator<Item = &'a Collider>,
        into: &mut Vec<(u32, Vec3)>,
    ) {
        into.clear();
        let cutting = colliders.into_iter().filter(|collider| can_cut(&*collider.shape.0));
        let mut cutting = cutting.peekable();
        if cutting.peek().is_none() {
            return;
        }
        self.lifts.clear();
        self.lifts.resize(positions.len(), Vec3::ZERO);
        for collider in cutting {
            let pose = collider.pose_at(1.0);
            let lifted = positions.iter().zip(&self.lifts).map(|(at, lift)| at + lift);
            self.positions.clear();
            self.positions.extend(lifted.map(|at| pose.inverse_transform_point(at)));
            self.planes.clear();
            self.planes.resize(positions.len(), None);
            let obstacle = Obstacle::new(collider, thickness);
            for _ in 0..SWEEPS {
                if !self.sweep(fabric, &obstacle, pose.rotation) {
                    break;
                }
            }
        }
        let displaced = (0..).zip(&self.lifts).filter(|(_, lift)| **lift != Vec3::ZERO);
        into.extend(displaced.map(|(particle, lift)| (particle, *lift)));
    }

    /// Lifts every triangle that an obstacle cuts. Returns whether any was cut.
    fn sweep(&mut self, fabric: &Fabric, obstacle: &Obstacle, rotation: Quat) -> bool {
        let mut any = false;
        for triangle in fabric.triangles() {
            let particles = triangle.map(|particle| particle as usize);
            let corners = particles.map(|particle| self.positions[particle]);
            if obstacle.is_beside(&corners) || self.is_above(particles, &corners, obstacle) {
                continue;
            }
            let Some(cut) = obstacle.deepest_cut(&corners) else { continue };
            let mut weights = cut.weights;
            for (weight, particle) in weights.iter_mut().zip(particles) {
                if fabric.is_pinned(particle) {
                    *weight = 0.0;
                }
            }
            let sum: f32 = weights.iter().map(|weight| weight * weight).sum();
            if sum < LEAST_WEIGHT {
                continue;
            }
            any = true;
            for (weight, particle) in weights.into_iter().zip(particles) {
                let lift = cut.normal * (cut.depth * weight / sum);
                self.positions[particle] += lift;
                self.lifts[particle] += rotation * lift;
                self.planes[particle] = None;
            }
        }
        any
    }

    /// Whether the whole triangle lies above the plane nearest to one of its corners.
    fn is_above(
        &mut self,
        particles: [usize; 3],
        corners: &[Vec3; 3],
        obstacle: &Obstacle,
    ) -> bool {
        particles.into_iter().zip(corners).any(|(particle, corner)| {
            let plane = match self.planes[particle] {
                Some(plane) => plane,
                None => {
                    let Some(plane) = obstacle.nearest_plane(*corner) else { return false };
                    *self.planes[particle].insert(plane)
                }
            };
            plane.is_below(corners, obstacle.kept)
        })
    }
}

/// Whether a shape is solid, and can cut a triangle whose corners are outside.
fn can_cut(shape: &dyn Shape) -> bool {
    shape.as_halfspace().is_none() && shape.as_trimesh().is_none() && shape.as_polyline().is_none()
}

/// The plane of a shape's surface that is nearest to a point, in the shape's frame.
#[derive(Clone, Copy, Debug)]
struct Plane {
    /// Unit normal, out of the shape.
    normal: Vec3,
    /// Distance of the plane from the origin along its normal, m.
    offset: f32,
    /// Distance of the point from the surface, m; negative inside.
    distance: f32,
}

impl Plane {
    /// Whether all corners are above the plane by at least `distance` (m): such a plane of a convex shape
    /// separates the shape from the triangle.
    fn is_below(&self, corners: &[Vec3; 3], distance: f32) -> bool {
        corners.iter().all(|corner| self.normal.dot(*corner) - self.offset >= distance)
    }
}

/// The deepest cut of a shape into a triangle.
struct Cut {
    /// Barycentric coordinates in the triangle.
    weights: [f32; 3],
    /// Unit normal, out of the shape.
    normal: Vec3,
    /// Distance by which the point must move out, m.
    depth: f32,
}

/// A shape that triangles are lifted out of.
struct Obstacle<'a> {
    shape: &'a dyn Shape,
    /// The shape as ground, if it is a heightfield.
    ground: Option<&'a HeightField>,
    /// Box of all points nearer than [`kept`](Self::kept) to the shape, in the shape's frame.
    bounds: Aabb,
    /// Distance that triangles keep, m.
    kept: f32,
}

impl<'a> Obstacle<'a> {
    fn new(collider: &'a Collider, thickness: f32) -> Self {
        let shape = &*collider.shape.0;
        let kept = KEPT * (thickness + collider.margin).max(LEAST_CLEARANCE);
        let ground = collider.shape.as_heightfield();
        Self { shape, ground, bounds: shape.compute_local_aabb().loosened(kept), kept }
    }

    /// Whether a triangle is beside or above the whole shape.
    fn is_beside(&self, corners: &[Vec3; 3]) -> bool {
        let [a, b, c] = *corners;
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        low.cmpgt(self.bounds.maxs).any() || high.cmplt(self.bounds.mins).any()
    }

    /// The plane of the surface nearest to a point; none on the surface itself, and far above ground.
    fn nearest_plane(&self, at: Vec3) -> Option<Plane> {
        let nearest = match self.ground {
            Some(field) => ground::project(field, at, GROUND_REACH)?,
            None => self.shape.project_local_point(at, false),
        };
        let away = if nearest.is_inside { nearest.point - at } else { at - nearest.point };
        let length = away.length();
        let normal = (length > LEAST_LENGTH).then(|| away / length)?;
        let distance = if nearest.is_inside { -length } else { length };
        Some(Plane { normal, offset: normal.dot(nearest.point), distance })
    }

    /// The deepest point of a triangle that is nearer than permitted, found by steps along the triangle
    /// against the normal of the nearest plane, which is the gradient of the distance.
    fn deepest_cut(&self, corners: &[Vec3; 3]) -> Option<Cut> {
        let [a, b, c] = *corners;
        let triangle = Triangle::new(a, b, c);
        let longest = (b - a).length().max((c - b).length()).max((a - c).length());
        let mut at = (a + b + c) / 3.0;
        let mut step = FIRST_STEP * longest;
        let mut deepest: Option<(Vec3, Plane)> = None;
        for _ in 0..STEPS {
            let plane = self.nearest_plane(at)?;
            if plane.is_below(corners, self.kept) {
                return None;
            }
            if deepest.is_none_or(|(_, deepest)| plane.distance < deepest.distance) {
                deepest = Some((at, plane));
            }
            at = triangle.project_local_point(at - step * plane.normal, true).point;
            step *= STEP_FACTOR;
        }
        let (at, plane) = deepest.filter(|(_, plane)| plane.distance < self.kept)?;
        let (_, location) = triangle.project_local_point_and_get_location(at, true);
        let weights = location.barycentric_coordinates()?;
        Some(Cut { weights, normal: plane.normal, depth: self.kept - plane.distance })
    }
}
