//! Motion of a cloth's frame, and the change of the state's coordinates by it.

use glam::{Quat, Vec3};

/// Motion of a cloth's frame in one tick: the pose of the new frame in the coordinates of the old one.
///
/// ```
/// use bunting_solver::FrameMotion;
/// use glam::{Quat, Vec3};
///
/// // A vehicle at 20 m/s, in a tick of 1/60 s.
/// let [from, to] = [Vec3::ZERO, Vec3::X * 20.0 / 60.0];
/// let motion = FrameMotion::between((from, Quat::IDENTITY), (to, Quat::IDENTITY));
/// assert!((motion.translation.length() - 1.0 / 3.0).abs() < 1e-6);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FrameMotion {
    /// Orientation of the new frame in the old one.
    pub rotation: Quat,
    /// Origin of the new frame in the old one, m.
    pub translation: Vec3,
}

impl FrameMotion {
    /// A frame at rest.
    pub const NONE: Self = Self { rotation: Quat::IDENTITY, translation: Vec3::ZERO };

    /// The motion from one pose to another, both in the world.
    #[must_use]
    pub fn between(from: (Vec3, Quat), to: (Vec3, Quat)) -> Self {
        if from == to {
            return Self::NONE;
        }
        let inverse = from.1.inverse();
        Self { rotation: (inverse * to.1).normalize(), translation: inverse * (to.0 - from.0) }
    }

    /// Whether the frame is at rest.
    #[must_use]
    pub fn is_none(&self) -> bool {
        *self == Self::NONE
    }

    /// Axis times angle of the rotation in the tick, rad; the same along the axes of the old and the new frame.
    #[must_use]
    pub fn turn(&self) -> Vec3 {
        let rotation = if self.rotation.w < 0.0 { -self.rotation } else { self.rotation };
        let sine = rotation.xyz().length();
        if sine == 0.0 {
            return Vec3::ZERO;
        }
        rotation.xyz() * (2.0 * libm::atan2f(sine, rotation.w) / sine)
    }

    /// The orientation after a fraction of the tick, turning at a constant rate about a fixed axis.
    #[must_use]
    pub fn rotation_at(&self, part: f32) -> Quat {
        let rotation = if self.rotation.w < 0.0 { -self.rotation } else { self.rotation };
        let sine = rotation.xyz().length();
        if sine == 0.0 {
            return Quat::IDENTITY;
        }
        // atan2 keeps the angle of small turns, which arccos(w) loses.
        let half_angle = part * libm::atan2f(sine, rotation.w);
        let axis = rotation.xyz() * (libm::sinf(half_angle) / sine);
        Quat::from_xyzw(axis.x, axis.y, axis.z, libm::cosf(half_angle))
    }

    /// Coordinates of a direction along the frame's axes after substep `index` of `count`, from its
    /// coordinates along the axes at the end of the tick.
    pub(crate) fn turn_back(&self, direction: Vec3, index: u32, count: u32) -> Vec3 {
        if self.is_none() {
            return direction;
        }
        let now = self.rotation_at((index + 1) as f32 / count as f32);
        now.inverse() * (self.rotation * direction)
    }

    /// The turn that leads from coordinates of a direction along the axes after substep `index` of `count` to those at the
    /// end of the tick.
    pub(crate) fn turn_to_end(&self, index: u32, count: u32) -> Quat {
        if self.is_none() {
            return Quat::IDENTITY;
        }
        self.rotation.inverse() * self.rotation_at((index + 1) as f32 / count as f32)
    }

    /// Change of coordinates in substep `index` of `count`: the frame turns at a constant rate while its
    /// origin moves along a straight line.
    pub(crate) fn substep(&self, index: u32, count: u32) -> FrameStep {
        if self.is_none() {
            return FrameStep::NONE;
        }
        let part = 1.0 / count as f32;
        let turned = self.rotation_at((index + 1) as f32 * part);
        let step = self.rotation_at(part);
        FrameStep {
            turn: Turn::new(step.inverse()),
            shift: turned.inverse() * (self.translation * -part),
            moves: true,
        }
    }
}

impl Default for FrameMotion {
    fn default() -> Self {
        Self::NONE
    }
}

/// A rotation matrix minus the identity: for a small turn the rotation matrix itself loses digits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Turn {
    pub rows: [Vec3; 3],
}

impl Turn {
    fn new(rotation: Quat) -> Self {
        let [x, y, z, w] = rotation.to_array();
        let two = 2.0;
        Self {
            rows: [
                two * Vec3::new(-(y * y + z * z), x * y - w * z, x * z + w * y),
                two * Vec3::new(x * y + w * z, -(x * x + z * z), y * z - w * x),
                two * Vec3::new(x * z - w * y, y * z + w * x, -(x * x + y * y)),
            ],
        }
    }
}

/// Change of coordinates of points that are fixed in the world while a cloth's frame moves by one substep: x
/// becomes x + turn · x + shift.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FrameStep {
    pub turn: Turn,
    /// Shift of the coordinates, m.
    pub shift: Vec3,
    /// Whether the frame moves.
    pub moves: bool,
}

impl FrameStep {
    pub const NONE: Self =
        Self { turn: Turn { rows: [Vec3::ZERO; 3] }, shift: Vec3::ZERO, moves: false };

    /// The new coordinates of a point that is fixed in the world.
    pub fn to_new(self, point: Vec3) -> Vec3 {
        point + (Vec3::from_array(self.turn.rows.map(|row| row.dot(point))) + self.shift)
    }

    /// The old coordinates of a point that is fixed in the world.
    pub fn to_old(self, point: Vec3) -> Vec3 {
        // The transpose of 1 + turn is its inverse.
        let moved = point - self.shift;
        let [x, y, z] = self.turn.rows;
        moved + (x * moved.x + y * moved.y + z * moved.z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The new coordinates of a point; asserts that they lead back to the old ones.
    fn moved(frame: &FrameStep, point: Vec3) -> Vec3 {
        let moved = frame.to_new(point);
        assert!(frame.to_old(moved).distance(point) < 1e-6);
        moved
    }

    #[test]
    fn substeps_add_up_to_the_tick() {
        let motion = FrameMotion {
            rotation: Quat::from_euler(glam::EulerRot::XYZ, 0.3, -0.2, 0.5),
            translation: Vec3::new(0.3, -0.1, 0.2),
        };
        let point = Vec3::new(0.4, 1.0, -0.7);
        let whole = motion.rotation.inverse() * (point - motion.translation);
        let steps = (0..7).fold(point, |point, index| moved(&motion.substep(index, 7), point));
        assert!(steps.distance(whole) < 1e-6, "{steps} {whole}");
    }

    #[test]
    fn a_small_turn_keeps_its_digits() {
        let angle = 1e-5_f32;
        let motion =
            FrameMotion { rotation: Quat::from_rotation_z(angle), translation: Vec3::ZERO };
        let moved = moved(&motion.substep(0, 10), Vec3::X);
        assert!((moved.y / (-angle / 10.0) - 1.0).abs() < 1e-4, "{moved}");
    }

    #[test]
    fn between_poses() {
        let from = (Vec3::new(1.0, 2.0, 3.0), Quat::from_rotation_y(0.4));
        let to = (Vec3::new(1.5, 2.0, 2.0), Quat::from_rotation_x(-0.9));
        let motion = FrameMotion::between(from, to);
        let local = Vec3::new(0.1, 0.2, 0.3);
        let world = to.0 + to.1 * local;
        let through_old = from.0 + from.1 * (motion.translation + motion.rotation * local);
        assert!(world.distance(through_old) < 1e-5);
    }
}
