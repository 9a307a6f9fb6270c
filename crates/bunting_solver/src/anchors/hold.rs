//! Holds: free particles that a spring or a rail holds from outside.

use std::sync::Arc;

use glam::{Quat, Vec3};

/// A free particle that is held from outside, by a spring or on a rail: see
/// [`ClothBatch::hold`](crate::ClothBatch::hold).
///
/// ```
/// use bunting_solver::{Hold, Holder};
/// use glam::Vec3;
///
/// // A spring that stays where it is, and gives way at 30 N.
/// let spring = Holder::Spring { place: [Vec3::ZERO; 2], stiffness: 200.0, max_force: 30.0 };
/// let hold = Hold { particle: 0, by: spring };
/// # assert_eq!(hold.particle, 0);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Hold {
    /// Index of the particle. One that is pinned is not held.
    pub particle: u32,
    /// The place where it is held.
    pub by: Holder,
}

/// That which holds a particle. Places are in the cloth's frame, at the start and at the end of a tick, each in the frame
/// at that time.
///
/// ```
/// use std::sync::Arc;
/// use bunting_solver::Holder;
/// use glam::{Quat, Vec3};
///
/// // A ring of 20 g on a straight rail of two metres that does not move.
/// let rail = Arc::new([Vec3::ZERO, 2.0 * Vec3::X]);
/// let pose = [(Vec3::ZERO, Quat::IDENTITY); 2];
/// let ring = Holder::Ring { rail, pose, mass: 0.02, friction: 0.1 };
/// # assert!(matches!(ring, Holder::Ring { .. }));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum Holder {
    /// A spring to a point.
    Spring {
        /// The point at the start and at the end of the tick, m.
        place: [Vec3; 2],
        /// Stiffness, N/m.
        stiffness: f32,
        /// Greatest force, N: a spring that would pull harder yields.
        max_force: f32,
    },
    /// A ring that slides on a rail.
    Ring {
        /// The corners of the rail in its own frame, m: one is a hook, two are a straight rail.
        rail: Arc<[Vec3]>,
        /// Position (m) and orientation of the rail at the start and at the end of the tick.
        pose: [(Vec3, Quat); 2],
        /// Mass of the ring, kg, which the rail carries, too. In a substep of τ seconds it holds the cloth with a stiffness of mass/τ².
        mass: f32,
        /// Coulomb friction coefficient.
        friction: f32,
    },
}

impl Hold {
    /// Whether every number is finite, and none is negative; a greatest force may be infinite.
    pub(crate) fn is_valid(&self) -> bool {
        let is_number = |value: f32| value.is_finite() && value >= 0.0;
        match &self.by {
            Holder::Spring { place, stiffness, max_force } => {
                place.iter().all(|at| at.is_finite()) && is_number(*stiffness) && *max_force >= 0.0
            }
            Holder::Ring { rail, pose, mass, friction } => {
                !rail.is_empty()
                    && rail.iter().all(|at| at.is_finite())
                    && pose.iter().all(|(at, turn)| at.is_finite() && turn.is_finite())
                    && *mass > 0.0
                    && is_number(*mass)
                    && is_number(*friction)
            }
        }
    }
}

impl Holder {
    /// Position and orientation after a part of the tick, m.
    pub(crate) fn pose(&self, part: f32) -> (Vec3, Quat) {
        match self {
            Self::Spring { place: [from, to], .. } => (from.lerp(*to, part), Quat::IDENTITY),
            Self::Ring { pose: [from, to], .. } => {
                (from.0.lerp(to.0, part), from.1.slerp(to.1, part))
            }
        }
    }

    /// The point after a part of the tick at which a particle is held, m, given the position to which it would move.
    pub(crate) fn place(&self, part: f32, free: Vec3) -> Vec3 {
        let (at, turn) = self.pose(part);
        match self {
            Self::Spring { .. } => at,
            Self::Ring { rail, .. } => at + turn * nearest(rail, turn.inverse() * (free - at)).0,
        }
    }
}

/// The point of a rail nearest to another point, m, and the direction of the rail there.
pub(crate) fn nearest(rail: &[Vec3], to: Vec3) -> (Vec3, Vec3) {
    let mut best = (rail[0], Vec3::ZERO);
    for (index, ends) in rail.windows(2).enumerate() {
        let along = ends[1] - ends[0];
        let part = (to - ends[0]).dot(along) / along.length_squared().max(f32::MIN_POSITIVE);
        let at = ends[0] + along * part.clamp(0.0, 1.0);
        if index == 0 || at.distance_squared(to) < best.0.distance_squared(to) {
            best = (at, along.normalize_or_zero());
        }
    }
    best
}
