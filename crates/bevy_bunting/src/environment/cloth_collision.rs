//! The component of cloths that do not pass through one another.

use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;

/// Keeps a cloth from passing through other cloths that have this component, too, whatever their meshes, materials and
/// frames. Without it, cloths pass through one another. [`ClothLayers`](crate::ClothLayers) say which cloths touch. Friction
/// is the geometric mean of both materials' `surface_friction`.
///
/// Cloths near one another are solved together on one thread: a cloth that is near no other one pays for a comparison of
/// boxes alone; the more cloth lies upon cloth, the more it costs. A cloth that is paused, or asleep outside of the
/// picture, touches no other. A thickness that is not finite and greater than zero is reported as
/// [`ClothError::Collision`](crate::ClothError::Collision), and the cloth passes through others.
///
/// ```
/// use bevy_bunting::prelude::*;
///
/// let towel = (ClothMesh::grid(17, 17, 0.5, 0.5), ClothCollision::default());
/// let tablecloth = (ClothMesh::grid(33, 33, 1.5, 1.5), ClothCollision::default());
/// # assert_eq!(towel.1, tablecloth.1);
/// ```
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
pub struct ClothCollision {
    /// Distance that the cloth keeps from others, m: two keep the mean of theirs.
    pub thickness: f32,
    /// Number of levels of detail that do not pass through others: the finest ones. Coarser levels do.
    pub levels: usize,
}

impl Default for ClothCollision {
    /// Cloths 5 mm apart, at the two finest levels.
    fn default() -> Self {
        Self { thickness: 5e-3, levels: 2 }
    }
}

impl ClothCollision {
    /// Whether the thickness is finite and greater than zero.
    pub(super) fn is_valid(&self) -> bool {
        self.thickness.is_finite() && self.thickness > 0.0
    }
}
