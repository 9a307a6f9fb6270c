//! Where and how a collider pushes a particle in a substep.

use glam::Vec3;

/// Where and how a collider pushes a particle, in the collider's frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touch {
    /// Unit normal of the surface, out of the shape.
    pub normal: Vec3,
    /// The point of the collider that pushes, m.
    pub at: Vec3,
    /// Whether the particle moves with the collider in this substep.
    pub sticks: bool,
}
