//! The material of a cloth.

use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bunting_solver::FabricMaterial;

use crate::cloth::reflect::FabricMaterialReflect;

/// The material of a cloth: area density (kg/m²), stiffnesses, damping, friction, thickness. Flag
/// polyester by default.
///
/// The material may be changed at any time, and may differ between cloths that share a fabric. A material
/// that cannot be simulated is reported in a [`ClothFailed`](crate::ClothFailed) event, and the cloth keeps
/// its last valid one.
///
/// ```
/// use bevy_bunting::prelude::*;
///
/// // Silk that is heavier and stiffer in bending.
/// let silk = FabricMaterial { area_density: 0.1, bend_stiffness: 2e-5, ..FabricMaterial::SILK };
/// let scarf = (ClothMesh::grid(9, 65, 0.2, 1.6), ClothMaterial(silk));
/// # assert_eq!(scarf.1.0.warp_stiffness, ClothMaterial::SILK.0.warp_stiffness);
/// ```
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
pub struct ClothMaterial(
    /// The material's values, in SI units.
    #[reflect(remote = FabricMaterialReflect)]
    pub FabricMaterial,
);

impl ClothMaterial {
    /// [`FabricMaterial::FLAG_POLYESTER`].
    pub const FLAG_POLYESTER: Self = Self(FabricMaterial::FLAG_POLYESTER);
    /// [`FabricMaterial::NYLON`].
    pub const NYLON: Self = Self(FabricMaterial::NYLON);
    /// [`FabricMaterial::COTTON`].
    pub const COTTON: Self = Self(FabricMaterial::COTTON);
    /// [`FabricMaterial::SILK`].
    pub const SILK: Self = Self(FabricMaterial::SILK);
    /// [`FabricMaterial::DENIM`].
    pub const DENIM: Self = Self(FabricMaterial::DENIM);
}
