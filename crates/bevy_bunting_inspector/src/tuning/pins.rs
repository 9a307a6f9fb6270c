//! Pins in a tuning file.

use core::any::TypeId;

use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_reflect::{FromReflect, TypeRegistry};
use ron::value::RawValue;

use crate::tuning::error::{Failed, TuningProblem};
use crate::tuning::value::read_value;

/// The key of the pins.
const KEY: &str = "pins";

/// Pins from their text, for a cloth with a mesh.
pub fn read_pins(
    text: &RawValue,
    mesh: &ClothMesh,
    types: &TypeRegistry,
) -> Result<AttachedVertices, Failed> {
    let failed = |problem| (KEY.to_owned(), problem);
    let registration = types.get(TypeId::of::<AttachedVertices>());
    let registration = registration.ok_or_else(|| failed(TuningProblem::Unknown))?;
    let value = read_value(KEY.to_owned(), text, registration, types)?;
    let pins = AttachedVertices::from_reflect(&*value);
    let pins = pins.ok_or_else(|| failed(TuningProblem::Unknown))?;
    let vertices = mesh.vertex_count();
    match &pins {
        AttachedVertices::List(list) if list.is_empty() => Err(failed(TuningProblem::NoPins)),
        AttachedVertices::Points(points) if points.is_empty() => Err(failed(TuningProblem::NoPins)),
        AttachedVertices::List(list) => match list.iter().find(|&&it| it as usize >= vertices) {
            Some(&vertex) => Err(failed(TuningProblem::NoVertex { vertex, vertices })),
            None => Ok(pins),
        },
        _ => Ok(pins),
    }
}

/// Makes pins the vertices of a cloth's attachment.
pub fn hold(world: &mut World, cloth: Entity, pins: AttachedVertices) {
    if let Some(mut attachment) = world.get_mut::<Attachment>(cloth) {
        attachment.vertices = pins;
    } else {
        world.entity_mut(cloth).insert(Attachment::in_place(pins));
    }
}
