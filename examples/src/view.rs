//! What a viewer sees.

use bevy::prelude::*;

/// Where a viewer is, and what it looks at.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// Position of the viewer, m.
    pub eye: Vec3,
    /// The point at which the viewer looks, m.
    pub centre: Vec3,
}

impl View {
    /// The pose of a viewer.
    #[must_use]
    pub fn pose(self) -> Transform {
        Transform::from_translation(self.eye).looking_at(self.centre, Vec3::Y)
    }
}
