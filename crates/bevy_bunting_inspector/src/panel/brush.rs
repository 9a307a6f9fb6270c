//! The brush that paints pins.

use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_egui::egui::{Slider, Ui};

/// Least and greatest radius of the brush, m.
const RADII: [f32; 2] = [0.005, 0.5];

/// What a pointer does to the selected cloth, in the order of the buttons.
const STROKES: [(&str, PinStroke); 3] =
    [("Drag", PinStroke::Off), ("Paint pins", PinStroke::Paint), ("Erase pins", PinStroke::Erase)];

/// Shows what a pointer does to the selected cloth: it drags it, paints its pins or erases them. Without
/// [`ClothDragPlugin`], which does all that, nothing is shown.
pub fn show_brush(world: &mut World, cloth: Entity, ui: &mut Ui) {
    let Some(mut brush) = world.get_resource_mut::<PinBrush>() else { return };
    let mut changed = PinBrush { only: Some(cloth), ..brush.clone() };
    ui.horizontal_wrapped(|ui| {
        ui.label("Pointer");
        for (name, stroke) in STROKES {
            ui.selectable_value(&mut changed.stroke, stroke, name);
        }
        let [least, greatest] = RADII;
        let radius = Slider::new(&mut changed.radius, least..=greatest);
        ui.add(radius.logarithmic(true).suffix(" m").text("radius"));
    });
    brush.set_if_neq(changed);
}
