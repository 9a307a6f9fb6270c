//! Paths of particles that cannot touch a collider in a substep, found without asking its shape.

use glam::{Affine3A, Mat3, Mat3A, Vec3, Vec3A};
use parry3d::math::Pose;

use crate::contact::collider::Collider;
use crate::step::frame::FrameStep;

/// How much longer than it is a path is taken to be: more than rounding.
pub(super) const LONGER: f32 = 1.001;

/// Distance by which a path must miss what it might touch, m: more than the rounding of coordinates of tens of metres.
const SLACK: f32 = 1e-4;

/// The box around a collider in a substep, which a path does not touch whose end is farther from it than it is long.
pub(super) struct Reach {
    /// Changes of coordinates from the cloth's present frame to the collider's at the start and at the end of the
    /// substep.
    into_collider: [Affine3A; 2],
    /// Least and greatest coordinates of the shape in its frame, m.
    bounds: [Vec3A; 2],
    /// Distance from the shape that counts as touching, m.
    clearance: f32,
}

impl Reach {
    /// The reach of a collider with these poses at the start and at the end of a substep.
    pub fn new(collider: &Collider, poses: [&Pose; 2], frame: &FrameStep, clearance: f32) -> Self {
        let bounds = if collider.shape.as_heightfield().is_some() {
            // All that is below counts as in the ground.
            [Vec3A::NEG_INFINITY, Vec3A::INFINITY]
        } else {
            let bounds = collider.shape.compute_local_aabb();
            [bounds.mins.into(), bounds.maxs.into()]
        };
        let [start, end] = poses.map(inverse);
        let to_old = Affine3A::from_mat3(
            Mat3::IDENTITY + Mat3::from_cols_array_2d(&frame.turn.rows.map(|row| row.to_array())),
        ) * Affine3A::from_translation(-frame.shift);
        Self { into_collider: [start * to_old, end], bounds, clearance: clearance + SLACK }
    }

    pub fn to_collider(&self) -> &[Affine3A; 2] {
        &self.into_collider
    }

    /// Both ends of the path of a particle that moves between two points in the cloth's frame, in the collider's frame, m, so that
    /// the path is relative to the surface; the first end is taken before the cloth's frame moved. None if the particle cannot
    /// touch the collider.
    #[inline]
    pub fn path(&self, start: Vec3, end: Vec3) -> Option<(Vec3, Vec3)> {
        let [at_start, at_end] = &self.into_collider;
        let from = at_start.transform_point3a(start.into());
        let to = at_end.transform_point3a(end.into());
        let [least, greatest] = self.bounds;
        let outside = (least - to).max(to - greatest).max_element();
        let is_missed = outside > self.clearance + LONGER * from.distance(to);
        (!is_missed).then(|| (from.into(), to.into()))
    }
}

fn inverse(pose: &Pose) -> Affine3A {
    let matrix3 = Mat3A::from_quat(pose.rotation.inverse());
    Affine3A { matrix3, translation: matrix3 * Vec3A::from(-pose.translation) }
}

#[cfg(test)]
mod tests {
    use glam::Quat;
    use parry3d::shape::SharedShape;

    use super::*;
    use crate::step::frame::FrameMotion;

    #[test]
    fn paths_that_touch_are_not_missed_and_most_others_are() {
        let clearance = 0.01;
        let shape = SharedShape::capsule_y(0.2, 0.05);
        let collider = Collider::fixed(shape.clone(), Vec3::ZERO, Quat::IDENTITY);
        let pose = |angle: f32, x: f32| {
            Pose::from_parts(Vec3::new(x, 0.1, -0.2), Quat::from_rotation_z(angle))
        };
        let (start, end) = (pose(0.4, 0.3), pose(0.5, 0.28));
        let motion = FrameMotion {
            rotation: Quat::from_rotation_y(0.1),
            translation: Vec3::new(0.02, 0.0, 0.05),
        };
        let frame = motion.substep(0, 1);
        let reach = Reach::new(&collider, [&start, &end], &frame, clearance);
        let (mut touching, mut missed, mut others) = (0, 0, 0);
        for index in 0..20_000 {
            let number = |step: f32| (index as f32 * step).fract() - 0.5;
            let from = Vec3::new(number(0.618_034), number(0.754_878), number(0.569_84));
            let way = Vec3::new(number(0.819_173), number(0.671_044), number(0.549_7)) * 0.2;
            let path = [
                start.inverse_transform_point(frame.to_old(from)),
                end.inverse_transform_point(from + way),
            ];
            let touches = (0..=20).any(|part| {
                let at = path[0].lerp(path[1], part as f32 / 20.0);
                shape.distance_to_local_point(at, true) < clearance
            });
            let is_missed = reach.path(from, from + way).is_none();
            assert!(!(touches && is_missed), "{path:?}");
            touching += usize::from(touches);
            missed += usize::from(is_missed);
            others += usize::from(!touches);
        }
        assert!(touching > 200 && 10 * missed > 8 * others, "{touching} {missed} {others}");
    }
}
