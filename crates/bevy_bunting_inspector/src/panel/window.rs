//! The content of the panel.

use bevy_bunting::LodReport;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_egui::egui::Ui;
use bevy_inspector_egui::bevy_inspector::ui_for_resource;

use crate::panel::cloths::{list_cloths, show_selected};
use crate::panel::components::show_components;
use crate::panel::files::show_file;
use crate::panel::plots::show_plots;
use crate::parameters::{WIND, winds};

/// Shows the cloths, the selected one, winds, settings, times and files in a `Ui` of egui, for apps that have a panel of their
/// own; [`ClothInspectorPlugin`](crate::ClothInspectorPlugin) shows it in a window.
///
/// The world needs [`ClothSelectionPlugin`](crate::ClothSelectionPlugin), [`PanelState`](crate::PanelState) and
/// `DefaultInspectorConfigPlugin` of bevy-inspector-egui, which expects the types of Bevy's asset plugins to be registered, as
/// `DefaultPlugins` do.
pub fn cloth_panel(world: &mut World, ui: &mut Ui) {
    list_cloths(world, ui);
    show_plots(world, ui);
    show_selected(world, ui);
    ui.collapsing("Winds", |ui| {
        for (name, wind) in winds(world) {
            let title = if name.is_empty() { wind.to_string() } else { name };
            ui.collapsing(title, |ui| show_components(world, wind, &WIND, ui));
        }
    });
    ui.collapsing("All cloths", |ui| {
        ui.strong("Settings");
        ui_for_resource::<ClothSettings>(world, ui);
        ui.strong("Budget");
        ui_for_resource::<ClothBudget>(world, ui);
        ui.strong("Choice of levels");
        ui_for_resource::<LodReport>(world, ui);
    });
    show_file(world, ui);
}
