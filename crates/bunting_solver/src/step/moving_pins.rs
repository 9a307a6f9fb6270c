//! Pins that move in the frame of their cloth during a tick.

use glam::Vec3;

/// The way of a pinned particle in the frame of its cloth, along a straight line in a tick.
///
/// ```
/// use bunting_solver::MovingPin;
/// use glam::Vec3;
///
/// let pin = MovingPin { particle: 3, from: Vec3::ZERO, to: 0.02 * Vec3::Y };
/// # assert!(pin.to.y > pin.from.y);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovingPin {
    /// Index of the particle.
    pub particle: u32,
    /// Position at the start of the tick, in the frame at that time, m.
    pub from: Vec3,
    /// Position at its end, in the frame at that time, m.
    pub to: Vec3,
}

/// The moving pins of a cloth.
#[derive(Clone, Debug, Default)]
pub(crate) struct MovingPins {
    /// In the tick that has begun.
    pub now: Vec<MovingPin>,
    /// In the next tick.
    pub next: Vec<MovingPin>,
    /// Positions of the pins among those of all particles, m; those of other particles are not filled in.
    pub positions: Vec<Vec3>,
    /// Whether no pair of pins is farther apart than at rest in this tick, so that they cannot strain the cloth.
    pub stay_near: bool,
}

impl MovingPins {
    /// Whether no pin moves, in this tick or the next.
    pub fn is_empty(&self) -> bool {
        self.now.is_empty() && self.next.is_empty()
    }
}
