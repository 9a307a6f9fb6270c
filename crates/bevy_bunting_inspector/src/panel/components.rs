//! The parameters of an entity.

use core::any::TypeId;

use bevy_ecs::prelude::*;
use bevy_egui::egui::{CollapsingHeader, Ui};
use bevy_inspector_egui::bevy_inspector::ui_for_value;

/// Shows those of some components that an entity has, the first one open, and inserts what is changed.
pub fn show_components(world: &mut World, entity: Entity, components: &[TypeId], ui: &mut Ui) {
    let types = world.resource::<AppTypeRegistry>().clone();
    let types = types.read();
    let mut is_first = true;
    for registration in components.iter().filter_map(|&of| types.get(of)) {
        let Some(component) = registration.data::<ReflectComponent>() else { continue };
        let value = component.reflect(world.entity(entity));
        let Some(Ok(mut value)) = value.map(|value| value.reflect_clone()) else { continue };
        let name = registration.type_info().type_path_table().short_path();
        CollapsingHeader::new(name).default_open(is_first).show(ui, |ui| {
            if ui_for_value(&mut *value, ui, world) {
                let mut entity = world.entity_mut(entity);
                component.insert(&mut entity, value.as_partial_reflect(), &types);
            }
        });
        is_first = false;
    }
}
