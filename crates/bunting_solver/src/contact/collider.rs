//! Shapes that a cloth cannot enter.

use glam::{Quat, Vec3};
use parry3d::bounding_volume::{Aabb, BoundingVolume};
use parry3d::math::Pose;
use parry3d::shape::SharedShape;

use crate::constants::LEAST_CLEARANCE;
use crate::step::frame::FrameMotion;

/// Fractions of the tick at which the box around a moving collider is computed.
pub(super) const SAMPLES: [f32; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

/// A shape that a cloth cannot enter. During a tick it moves along a straight line and turns at a constant
/// rate. Cloth does not push it.
///
/// ```
/// use bunting_solver::Collider;
/// use glam::{Quat, Vec3};
/// use parry3d::shape::SharedShape;
///
/// // A ball of 30 cm that moves by 10 cm in the tick.
/// let (ball, still) = (SharedShape::ball(0.3), Quat::IDENTITY);
/// let from = Collider::fixed(ball, Vec3::ZERO, still);
/// let moving = Collider { to: (0.1 * Vec3::X, still), friction: 0.3, ..from };
/// # assert!(moving.swept_box().maxs.x >= 0.4);
/// ```
#[derive(Clone)]
pub struct Collider {
    /// Any parry shape: ball, capsule, cuboid, half-space, mesh, compound …
    pub shape: SharedShape,
    /// Position (m) and orientation at the start of the tick, in the cloth's frame at that time.
    pub from: (Vec3, Quat),
    /// Position (m) and orientation at the end of the tick, in the cloth's frame at that time.
    pub to: (Vec3, Quat),
    /// Distance between shape and cloth in addition to the cloth's thickness, m.
    pub margin: f32,
    /// Coulomb friction coefficient of the shape. A contact uses the geometric mean of this and the cloth's
    /// coefficient.
    pub friction: f32,
    /// Whether edges, corners and small shapes are felt between the cloth's particles, by its triangles. Without, only
    /// particles touch, which costs less, and sheets come to rest on edges.
    pub features: bool,
    /// A number by which the host finds what the cloth does to this collider in
    /// [`ClothBatch::reactions`](crate::ClothBatch::reactions); none: it is not summed.
    pub reports_as: Option<u64>,
}

impl core::fmt::Debug for Collider {
    fn fmt(&self, formatter: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        formatter
            .debug_struct("Collider")
            .field("shape", &self.shape.shape_type())
            .field("from", &self.from)
            .field("to", &self.to)
            .field("margin", &self.margin)
            .field("friction", &self.friction)
            .field("features", &self.features)
            .field("reports_as", &self.reports_as)
            .finish()
    }
}

impl Collider {
    /// A collider that rests in the cloth's frame, without a margin and features.
    #[must_use]
    pub fn fixed(shape: SharedShape, position: Vec3, rotation: Quat) -> Self {
        let pose = (position, rotation);
        Self {
            shape,
            from: pose,
            to: pose,
            margin: 0.0,
            friction: 1.0,
            features: false,
            reports_as: None,
        }
    }

    /// Whether poses, margin and friction are finite.
    pub(crate) fn is_finite(&self) -> bool {
        let is_pose =
            |(position, rotation): (Vec3, Quat)| position.is_finite() && rotation.is_finite();
        is_pose(self.from)
            && is_pose(self.to)
            && self.margin.is_finite()
            && self.friction.is_finite()
    }

    /// Least distance from the shape of the particles of a cloth of a thickness, m.
    pub(super) fn clearance(&self, thickness: f32) -> f32 {
        (thickness + self.margin).max(LEAST_CLEARANCE)
    }

    /// Box around the shape in all its poses of the tick, without the margin, m.
    #[must_use]
    pub fn swept_box(&self) -> Aabb {
        let boxes = self.sampled_poses().map(|pose| self.shape.compute_aabb(&pose));
        let sampled = boxes.iter().fold(boxes[0], |all, other| all.merged(other));
        let beyond = self.beyond_samples(&self.shape.compute_local_aabb(), 0.0);
        Aabb::new(sampled.mins - beyond, sampled.maxs + beyond)
    }

    /// Greatest distance, m, by which a point of a box, given relative to the point about which it turns, leaves the straight
    /// lines between its places at the [`SAMPLES`], in a frame whose origin moves by a `way` (m) along axes that turn with it: an
    /// eighth of the square of the time between two samples times the greatest acceleration, ω² r + 2 ω v.
    pub(super) fn beyond_samples(&self, around: &Aabb, way: f32) -> f32 {
        let turn = FrameMotion::between(self.from, self.to).turn().length();
        if turn == 0.0 {
            return 0.0;
        }
        let farthest = around.mins.abs().max(around.maxs.abs()).length();
        // The box of a half-space reaches everywhere, and stays finite.
        if !farthest.is_finite() {
            return 0.0;
        }
        let intervals = (SAMPLES.len() - 1) as f32;
        turn * (turn * farthest + 2.0 * way) / (8.0 * intervals * intervals)
    }

    /// Poses at the [`SAMPLES`] of the tick.
    pub(super) fn sampled_poses(&self) -> [Pose; SAMPLES.len()] {
        SAMPLES.map(|part| self.pose_at(part))
    }

    /// Pose after a fraction of the tick, in the cloth's frame.
    pub(crate) fn pose_at(&self, part: f32) -> Pose {
        let turned = FrameMotion::between(self.from, self.to).rotation_at(part);
        Pose::from_parts(self.from.0.lerp(self.to.0, part), self.from.1 * turned)
    }
}

#[cfg(test)]
mod tests {
    use core::f32::consts::PI;

    use super::*;

    /// A rod of two metres that turns by almost half a turn about one of its ends, which moves on.
    #[test]
    fn a_swept_box_contains_what_turns_between_its_samples() {
        let rod = SharedShape::capsule(Vec3::ZERO, 2.0 * Vec3::X, 0.01);
        for begin in [0.0, 0.3, PI / 8.0, 1.0] {
            let pose = |angle: f32, x: f32| (Vec3::X * x, Quat::from_rotation_z(begin + angle));
            let still = Collider::fixed(rod.clone(), Vec3::ZERO, Quat::IDENTITY);
            let collider = Collider { from: pose(0.0, 0.0), to: pose(0.99 * PI, 0.5), ..still };
            let swept = collider.swept_box();
            for part in 0..=1000 {
                let pose = collider.pose_at(part as f32 / 1000.0);
                let now = rod.compute_aabb(&pose);
                assert!(swept.contains(&now), "{begin} {part}: {now:?} in {swept:?}");
            }
            assert!(swept.extents().max_element() < 6.5, "{swept:?}");
            let halfspace = SharedShape::halfspace(Vec3::Z);
            let everywhere = Collider { shape: halfspace, ..collider.clone() }.swept_box();
            assert!(everywhere.mins.is_finite() && everywhere.maxs.is_finite());
            let fixed = Collider { to: collider.from, ..collider.clone() };
            assert_eq!(fixed.swept_box(), rod.compute_aabb(&fixed.pose_at(0.0)));
        }
    }
}
