//! Where and how a collider pushes a particle in a substep.

use glam::Vec3;

/// The push of a collider to a particle, in the collider's frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touch {
    /// Unit normal of the surface, out of the shape.
    pub normal: Vec3,
    /// The point of the collider that pushes, m.
    pub at: Vec3,
    /// Displacement of the particle along the normal, m.
    pub depth: f32,
    /// Whether the particle moves with the collider in this substep.
    pub sticks: bool,
}

impl Touch {
    /// A touch that has not moved the particle yet.
    pub fn new(normal: Vec3, at: Vec3, sticks: bool) -> Self {
        Self { normal, at, depth: 0.0, sticks }
    }

    /// The deeper one of the touches of two triangles at a corner. Means of the normals were tried: between the sides of a
    /// thin shape they point anywhere, and a peg comes through. The last one was, too: the triangles around a particle are
    /// always solved in the same order, and pushed a ball on a sheet to one side.
    pub fn or_deeper(self, next: Self) -> Self {
        let deeper = if next.depth > self.depth { next } else { self };
        deeper.sticking(self.sticks || next.sticks)
    }

    /// This touch, of a particle that sticks if told so.
    pub fn sticking(self, sticks: bool) -> Self {
        Self { sticks, ..self }
    }
}
