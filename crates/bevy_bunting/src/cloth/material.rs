//! The material of a cloth.

use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bunting_solver::FabricMaterial;

/// The material of a cloth: area density (kg/m²), stiffnesses, damping, friction, thickness. Flag
/// polyester by default.
///
/// It may be changed at any time, and differ between cloths that share a fabric. A material that
/// cannot be simulated is reported in a [`ClothFailed`](crate::ClothFailed) event, and the cloth keeps
/// the one before.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[reflect(opaque)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
pub struct ClothMaterial(
    /// The material's values, in SI units.
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
