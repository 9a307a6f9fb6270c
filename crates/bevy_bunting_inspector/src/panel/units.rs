//! Units and steps of a material's numbers.

use core::any::TypeId;

use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_inspector_egui::inspector_options::std_options::NumberOptions;
use bevy_inspector_egui::inspector_options::{InspectorOptions, ReflectInspectorOptions, Target};
use bevy_reflect::{TypeInfo, TypeRegistry};

/// Fields of a [`FabricMaterial`]: name, step of a drag by a point, unit.
const FIELDS: [(&str, f32, &str); 11] = [
    ("area_density", 1e-3, " kg/m²"),
    ("warp_stiffness", 10.0, " N/m"),
    ("weft_stiffness", 10.0, " N/m"),
    ("shear_stiffness", 1.0, " N/m"),
    ("bend_stiffness", 1e-6, " N·m"),
    ("damping", 1e-2, " 1/s"),
    ("internal_damping", 1e-2, " 1/s"),
    ("pressure_coefficient", 1e-2, ""),
    ("friction_coefficient", 1e-3, ""),
    ("thickness", 1e-5, " m"),
    ("surface_friction", 1e-2, ""),
];

/// Shows the numbers of materials with their units, and as many digits as their steps have.
pub fn add_units(types: &AppTypeRegistry) {
    let mut types = types.write();
    let Some((material, options)) = options(&types) else { return };
    if let Some(material) = types.get_mut(material) {
        material.insert(ReflectInspectorOptions(options));
    }
}

/// The reflected type within a [`ClothMaterial`], and the options of its fields.
fn options(types: &TypeRegistry) -> Option<(TypeId, InspectorOptions)> {
    let TypeInfo::TupleStruct(cloth) = types.get_type_info(TypeId::of::<ClothMaterial>())? else {
        return None;
    };
    let material = cloth.field_at(0)?.type_id();
    let TypeInfo::Struct(fields) = types.get_type_info(material)? else { return None };
    let mut options = InspectorOptions::new();
    for (name, speed, unit) in FIELDS {
        let mut number = NumberOptions::<f32>::default();
        (number.min, number.speed, number.suffix) = (Some(0.0), speed, unit.to_owned());
        options.insert(Target::Field(fields.index_of(name)?), number);
    }
    Some((material, options))
}
