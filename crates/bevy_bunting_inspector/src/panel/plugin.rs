//! The plugin of the panel.

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;
use bevy_egui::{EguiContext, EguiPlugin, EguiPrimaryContextPass, PrimaryEguiContext, egui};
use bevy_inspector_egui::DefaultInspectorConfigPlugin;

use crate::panel::state::PanelState;
use crate::panel::units::add_units;
use crate::panel::window::cloth_panel;
use crate::selection::ClothSelectionPlugin;
use crate::strain::ClothStrainPlugin;

/// Width and height of the window at first, points.
const SIZE: [f32; 2] = [360.0, 640.0];

/// Shows the panel in a window of egui, on the first camera, while [`PanelState::is_open`]. It adds egui's plugin unless it
/// is added before.
///
/// ```no_run
/// use bevy_app::prelude::*;
/// use bevy_bunting::prelude::*;
/// use bevy_bunting_inspector::ClothInspectorPlugin;
///
/// // In an app: App::new().add_plugins((DefaultPlugins, ClothPlugins::default(), ClothDragPlugin, ClothInspectorPlugin));
/// App::new().add_plugins((ClothPlugins::default(), ClothDragPlugin, ClothInspectorPlugin));
/// ```
#[derive(Debug, Default)]
pub struct ClothInspectorPlugin;

impl Plugin for ClothInspectorPlugin {
    fn build(&self, app: &mut App) {
        if !app.is_plugin_added::<EguiPlugin>() {
            app.add_plugins(EguiPlugin::default());
        }
        if !app.is_plugin_added::<DefaultInspectorConfigPlugin>() {
            app.add_plugins(DefaultInspectorConfigPlugin);
        }
        app.add_plugins((ClothSelectionPlugin, ClothStrainPlugin))
            .init_resource::<PanelState>()
            .add_systems(EguiPrimaryContextPass, show);
    }

    fn finish(&self, app: &mut App) {
        // By now the types of all plugins are registered.
        add_units(app.world().resource());
    }
}

fn show(world: &mut World) {
    let mut contexts = world.query_filtered::<&mut EguiContext, With<PrimaryEguiContext>>();
    let Ok(mut context) = contexts.single_mut(world) else { return };
    let context = context.get_mut().clone();
    let mut is_open = world.resource::<PanelState>().is_open;
    let window = egui::Window::new("Cloth").default_size(SIZE).vscroll(true);
    window.open(&mut is_open).show(&context, |ui| cloth_panel(world, ui));
    world.resource_mut::<PanelState>().is_open = is_open;
}
