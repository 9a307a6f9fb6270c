//! The component of cloth that does not pass through itself.

use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;

/// Keeps a cloth from passing through itself. Without this component it does. Friction between layers is the material's
/// `surface_friction`.
///
/// A cloth that hardly folds pays for the search alone; the more layers lie upon one another, the more it costs.
///
/// ```
/// use bevy_bunting::prelude::*;
///
/// let towel = (ClothMesh::grid(17, 33, 0.5, 1.0), SelfCollision::default());
/// # assert!(towel.1.thickness > 0.0);
/// ```
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
pub struct SelfCollision {
    /// Distance that layers keep, m: particles from triangles, and edges from edges. Less where the mesh's own
    /// layers are nearer at rest. Cloth whose area is smaller than the square of it passes through itself, and an error says so.
    pub thickness: f32,
    /// Number of levels of detail that do not pass through themselves: the finest ones. Coarser levels do.
    pub levels: usize,
}

impl Default for SelfCollision {
    /// Layers 5 mm apart, at the finest level.
    fn default() -> Self {
        Self { thickness: 5e-3, levels: 1 }
    }
}
