//! Collision layers, and the levels of detail at which cloth feels small features of shapes.

use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;

/// Which cloths and colliders touch. A cloth touches a collider if each is a member of a layer that the other's filters
/// contain. Without this component, an entity is a member of all layers and touches all.
///
/// The bits are those of avian's `CollisionLayers` and of rapier's `CollisionGroups`.
///
/// ```
/// use bevy_bunting::prelude::*;
///
/// const PEOPLE: u32 = 1;
/// const CLOTHES: u32 = 2;
/// let body = (ClothCollider::capsule(0.5, 0.2), ClothLayers::new(PEOPLE, CLOTHES));
/// let cape = (ClothMesh::grid(17, 33, 0.8, 1.2), ClothLayers::new(CLOTHES, PEOPLE));
/// assert!(cape.1.touch(body.1));
/// ```
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq, Hash, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Default, Debug, PartialEq, Hash, Clone)]
pub struct ClothLayers {
    /// Layers that the entity is a member of, one a bit.
    pub memberships: u32,
    /// Layers that the entity touches, one a bit.
    pub filters: u32,
}

impl ClothLayers {
    /// All layers.
    pub const ALL: Self = Self { memberships: u32::MAX, filters: u32::MAX };

    /// A member of some layers that touches members of others, one layer a bit.
    #[must_use]
    pub const fn new(memberships: u32, filters: u32) -> Self {
        Self { memberships, filters }
    }

    /// Whether entities with these layers touch.
    #[must_use]
    pub const fn touch(self, other: Self) -> bool {
        self.memberships & other.filters != 0 && other.memberships & self.filters != 0
    }
}

impl Default for ClothLayers {
    /// A member of all layers that touches all, unlike avian's default of one layer: it is the same as no component.
    fn default() -> Self {
        Self::ALL
    }
}

/// The levels of detail at which a cloth feels features of shapes between its particles, such as the corner of a box or
/// a peg thinner than its mesh, where [`ClothCollider::features`](crate::ClothCollider::features) asks for it. At coarser
/// levels, and so at a distance, only its particles touch, which costs less. Without this component, a cloth has the default.
///
/// ```
/// use bevy_bunting::prelude::*;
///
/// // Corners are felt at the finest level only.
/// let tablecloth = (ClothMesh::grid(33, 33, 1.5, 1.5), ClothFeatures { levels: 1 });
/// # assert_ne!(tablecloth.1, ClothFeatures::default());
/// ```
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq, Hash, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Default, Debug, PartialEq, Hash, Clone)]
pub struct ClothFeatures {
    /// Number of levels that feel features: the finest ones. Zero: none.
    pub levels: usize,
}

impl Default for ClothFeatures {
    /// The two finest levels.
    fn default() -> Self {
        Self { levels: 2 }
    }
}
