//! The list of cloths, and the selected one.

use bevy_bunting::prelude::*;
use bevy_bunting::{ClothEffort, ClothPaused};
use bevy_ecs::prelude::*;
use bevy_egui::egui::{ScrollArea, Ui};
use bevy_inspector_egui::bevy_inspector::ui_for_entity;

use crate::panel::brush::show_brush;
use crate::panel::components::show_components;
use crate::parameters::CLOTH;
use crate::presets::PRESETS;
use crate::selection::SelectedCloth;

/// Height of the list of cloths, points.
const LIST: f32 = 120.0;

type Listed =
    (Entity, Option<&'static Name>, &'static ClothState, &'static ClothEffort, Has<ClothPaused>);

/// Lists all cloths with level, activity, substeps and the reason for them. A click selects one.
pub fn list_cloths(world: &mut World, ui: &mut Ui) {
    let mut cloths = world.query_filtered::<Listed, With<ClothMesh>>();
    let mut lines: Vec<_> = cloths.iter(world).map(line).collect();
    lines.sort();
    let SelectedCloth(mut selected) = *world.resource();
    ui.strong(format!("Cloths: {}", lines.len()));
    ScrollArea::vertical().id_salt("cloths").max_height(LIST).show(ui, |ui| {
        for (line, cloth) in &lines {
            if ui.selectable_label(selected == Some(*cloth), line).clicked() {
                selected = Some(*cloth);
            }
        }
    });
    world.resource_mut::<SelectedCloth>().set_if_neq(SelectedCloth(selected));
}

/// The line of a cloth, and the cloth.
fn line(
    (cloth, name, state, effort, is_paused): (
        Entity,
        Option<&Name>,
        &ClothState,
        &ClothEffort,
        bool,
    ),
) -> (String, Entity) {
    let name = name.map_or_else(|| cloth.to_string(), ToString::to_string);
    let StepSettings { substeps, passes, .. } = effort.settings();
    let level = state.level();
    let doing = match state.activity() {
        _ if is_paused => "paused".to_owned(),
        ClothActivity::Ticking => {
            format!("{substeps} × {passes} substeps by {:?}", effort.cause())
        }
        ClothActivity::AwaitsAsset => "awaits its mesh".to_owned(),
        ClothActivity::AwaitsFabric => "awaits its fabric".to_owned(),
        ClothActivity::AwaitsPreroll => "is simulated in advance".to_owned(),
        ClothActivity::Failed => "failed, see the log".to_owned(),
        asleep => format!("asleep: {asleep:?}"),
    };
    (format!("{name} · level {level} · {doing}"), cloth)
}

/// Shows presets, the brush and all parameters of the selected cloth.
pub fn show_selected(world: &mut World, ui: &mut Ui) {
    let SelectedCloth(Some(cloth)) = *world.resource() else {
        ui.label("No cloth is selected.");
        return;
    };
    ui.horizontal_wrapped(|ui| {
        ui.label("Material");
        for (name, material) in PRESETS {
            if ui.button(name).clicked() {
                world.entity_mut(cloth).insert(material);
            }
        }
    });
    show_brush(world, cloth, ui);
    show_components(world, cloth, &CLOTH, ui);
    ui.collapsing("All components", |ui| ui_for_entity(world, cloth, ui));
}
