//! Reflected forms of other crates' types that components contain, for inspectors and scene files.

use bevy_reflect::std_traits::ReflectDefault;
use bevy_reflect::{impl_type_path, reflect_remote};
use bunting_solver::FabricMaterial;
use parry3d::shape::SharedShape;

// Names without private modules, as of all other types.
impl_type_path!((in bevy_bunting) FabricMaterialReflect);
impl_type_path!((in bevy_bunting) SharedShapeReflect);

/// Reflected form of [`FabricMaterial`], field by field.
#[reflect_remote(FabricMaterial)]
#[reflect(type_path = false)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Default, Debug, PartialEq, Clone)]
pub struct FabricMaterialReflect {
    pub area_density: f32,
    pub warp_stiffness: f32,
    pub weft_stiffness: f32,
    pub shear_stiffness: f32,
    pub bend_stiffness: f32,
    pub damping: f32,
    pub internal_damping: f32,
    pub pressure_coefficient: f32,
    pub friction_coefficient: f32,
    pub thickness: f32,
    pub surface_friction: f32,
}

/// Reflected form of [`SharedShape`]: an opaque value, which parry serialises with the feature `serialize`.
#[reflect_remote(SharedShape)]
#[reflect(type_path = false)]
#[derive(Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[reflect(opaque)]
#[reflect(Clone)]
pub struct SharedShapeReflect;
