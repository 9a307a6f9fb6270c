//! Poses in a world that is moved as a whole.

use bevy_math::{Isometry3d, Vec3};

use super::PoseHistory;
use crate::motion::track::Teleport;

/// Part of the coordinates by which the pose of an entity that rests may be another after the world was moved: its transform
/// is computed from those above it, and rounded elsewhere. Smaller: children at rest move when the world is moved. Larger:
/// the beginning of a motion is taken for rounding.
const ROUNDING: f32 = 4.0 * f32::EPSILON;

/// A pose in the moved world, m.
fn shifted(pose: Isometry3d, by: Vec3) -> Isometry3d {
    // The sum of the components themselves, as transforms have it.
    Isometry3d::new(Vec3::from(pose.translation) + by, pose.rotation)
}

impl PoseHistory {
    /// Moves all poses along with the world, m. This is neither a motion nor a teleport.
    pub fn shift(&mut self, by: Vec3) {
        if let Some(last) = self.last {
            let before = Vec3::from(last.translation);
            let size = before.abs().max((before + by).abs()).max_element();
            self.rounding = Some(self.rounding.unwrap_or(0.0).max(ROUNDING * size));
        }
        self.change_poses(|pose| shifted(pose, by));
    }

    /// Takes the pose of an entity that rests for that which it had before the world was moved, if it differs by rounding.
    pub(super) fn settle(&mut self, pose: Isometry3d) {
        let Some((rounding, last)) = self.rounding.take().zip(self.last) else { return };
        let tracks = [&self.ticks, &self.frames];
        let rests = tracks.iter().all(|track| track.rests_at(last));
        let is_near = last.translation.distance(pose.translation) <= rounding
            && last.rotation.angle_between(pose.rotation) <= ROUNDING;
        if rests && is_near && last != pose {
            let teleport = Teleport { from: last, to: pose };
            self.change_poses(|earlier| teleport.carry(earlier));
        }
    }

    fn change_poses(&mut self, change: impl Fn(Isometry3d) -> Isometry3d) {
        self.ticks.change_poses(&change);
        self.frames.change_poses(&change);
        let spans = [&mut self.span, &mut self.extrapolated].into_iter().flatten();
        let of_spans = spans.flat_map(|(start, end)| [start, end]);
        let of_rest = self.rest.as_mut().map(|rest| &mut rest.pose);
        let others = [&mut self.last, &mut self.standing].into_iter().flatten();
        of_spans.chain(of_rest).chain(others).for_each(|pose| *pose = change(*pose));
    }
}
