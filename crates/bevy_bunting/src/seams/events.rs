//! Events of seams.

use bevy_ecs::prelude::*;

/// A [`Seam`](crate::Seam) has been drawn together all along. Triggered on the cloth.
///
/// ```
/// use bevy_app::prelude::*;
/// use bevy_bunting::prelude::*;
/// use bevy_ecs::prelude::*;
///
/// let mut app = App::new();
/// app.add_observer(|closed: On<ClothSeamClosed>| println!("seam {} is closed", closed.seam));
/// ```
#[derive(EntityEvent, Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClothSeamClosed {
    /// The cloth.
    pub entity: Entity,
    /// Index of the seam in [`ClothSeams`](crate::ClothSeams).
    pub seam: usize,
}

/// A [`Seam`](crate::Seam) that was closed, or closed in part, is open all along. Triggered on the cloth.
#[derive(EntityEvent, Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClothSeamOpened {
    /// The cloth.
    pub entity: Entity,
    /// Index of the seam in [`ClothSeams`](crate::ClothSeams).
    pub seam: usize,
}
