//! Buttons that save and load tuning files.

use std::path::Path;

use bevy_ecs::prelude::*;
use bevy_egui::egui::Ui;

use crate::panel::state::PanelState;
use crate::selection::SelectedCloth;
use crate::tuning::load::load_tuning;
use crate::tuning::save::save_tuning;

/// Shows the path of the tuning file, buttons, and what came of them.
pub fn show_file(world: &mut World, ui: &mut Ui) {
    let (mut save, mut load) = (false, false);
    let SelectedCloth(selected) = *world.resource();
    let mut state = world.resource_mut::<PanelState>();
    ui.horizontal(|ui| {
        ui.text_edit_singleline(&mut state.file);
        ui.add_enabled_ui(selected.is_some(), |ui| {
            save = ui.button("Save").clicked();
            load = ui.button("Load").clicked();
        });
    });
    let file = state.file.clone();
    ui.label(&state.message);
    let Some(cloth) = selected.filter(|_| save || load) else { return };
    let (done, verb) = if save {
        (save_tuning(world, cloth, Path::new(&file)), "saved")
    } else {
        (load_tuning(world, cloth, Path::new(&file)), "loaded")
    };
    let message = done.map_or_else(|error| error.to_string(), |()| format!("{file}: {verb}"));
    world.resource_mut::<PanelState>().message = message;
}
