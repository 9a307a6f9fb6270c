//! State that the sleep at rest keeps for each cloth from tick to tick.

use bevy_ecs::prelude::*;
use bevy_math::{Isometry3d, Vec3};

/// State that the sleep at rest keeps for a cloth.
#[derive(Component, Clone, Debug, Default)]
pub(crate) struct RestTimer {
    /// Number of ticks for which the cloth has been at rest.
    pub ticks: u32,
    /// Positions in the cloth's frame about which it rests, m times the size of cloth that has grown; none of cloth that moves fast.
    pub places: Vec<Vec3>,
    /// First of the cloths that the cloth may touch in this tick, which come to rest together; none without them.
    pub group: Option<Entity>,
    /// Pose of the frame at the end of the last tick.
    pub pose: Option<Isometry3d>,
    /// Distance by which the frame may be elsewhere since the world was moved, m.
    pub rounding: f32,
}

/// Part of the coordinates by which the frame of a cloth that rests may be elsewhere after the world was moved. Smaller:
/// cloth that is the child of another entity wakes. Larger: a frame that is moved by less does not wake it.
const ROUNDING: f32 = 4.0 * f32::EPSILON;

impl RestTimer {
    /// Counts a tick in which nothing disturbs the cloth, which rests as long as the root mean square distance of its particles
    /// from where they were when it came to rest is at most `way`, m times the size of cloth that has grown.
    pub fn count(&mut self, positions: &[Vec3], previous: &[Vec3], way: f32) {
        if distance(&self.places, positions) <= way {
            self.ticks += 1;
            return;
        }
        self.restart();
        // Cloth that moves farther in a tick does not come to rest in the next one.
        if distance(previous, positions) <= way {
            self.places.extend_from_slice(positions);
        }
    }

    /// Counts from zero again: something acts on the cloth, or it has fallen asleep.
    pub fn restart(&mut self) {
        self.ticks = 0;
        self.places.clear();
    }

    /// Moves the pose along with the world, m.
    pub fn shift(&mut self, by: Vec3) {
        let Some(pose) = &mut self.pose else { return };
        let before = Vec3::from(pose.translation);
        let now = before + by;
        self.rounding = self.rounding.max(ROUNDING * before.abs().max(now.abs()).max_element());
        pose.translation = now.into();
    }

    /// Whether the frame of a cloth has moved to a pose, but for rounding in a world that was moved.
    pub fn has_moved_to(&mut self, pose: Isometry3d) -> bool {
        let rounding = core::mem::take(&mut self.rounding);
        let is_near = |it: Isometry3d| {
            it.rotation.angle_between(pose.rotation) <= ROUNDING
                && it.translation.distance(pose.translation) <= rounding
        };
        if rounding > 0.0 && self.pose.is_some_and(is_near) {
            self.pose = Some(pose);
        }
        self.pose != Some(pose)
    }
}

/// Root mean square distance of particles from places, m; infinite if there are other numbers of them.
fn distance(places: &[Vec3], positions: &[Vec3]) -> f32 {
    if places.len() != positions.len() {
        return f32::INFINITY;
    }
    let squares = places.iter().zip(positions).map(|(place, at)| place.distance_squared(*at));
    (squares.sum::<f32>() / positions.len().max(1) as f32).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    const WAY: f32 = 1e-3;

    /// Counts ticks in which a cloth of two particles is displaced by given lengths, m, and returns how long it has rested.
    fn rested(displacements: &[f32]) -> u32 {
        let at = |by: f32| [by * Vec3::X, Vec3::Z + by * Vec3::Y];
        let mut timer = RestTimer::default();
        for displacements in displacements.windows(2) {
            timer.count(&at(displacements[1]), &at(displacements[0]), WAY);
        }
        timer.ticks
    }

    #[test]
    fn what_trembles_rests_and_what_creeps_does_not() {
        let trembles: Vec<f32> = (0..100).map(|tick| 0.9 * WAY * (tick % 2) as f32).collect();
        let creeps: Vec<f32> = (0..100).map(|tick| 0.3 * WAY * tick as f32).collect();
        let falls: Vec<f32> = (0..100).map(|tick| 3.0 * WAY * tick as f32).collect();
        assert_eq!([&trembles, &creeps, &falls].map(|it| rested(it)), [98, 2, 0]);
    }

    #[test]
    fn a_restart_ends_the_rest() {
        let mut timer = RestTimer::default();
        let at = [Vec3::ZERO];
        (0..9).for_each(|_| timer.count(&at, &at, WAY));
        assert_eq!(timer.ticks, 8);
        timer.restart();
        timer.count(&at, &at, WAY);
        assert_eq!(timer.ticks, 0);
    }

    #[test]
    fn another_level_is_no_rest() {
        let mut timer = RestTimer::default();
        let at = [Vec3::ZERO; 2];
        (0..9).for_each(|_| timer.count(&at, &at, WAY));
        timer.count(&at[..1], &at[..1], WAY);
        assert_eq!(timer.ticks, 0);
    }
}
