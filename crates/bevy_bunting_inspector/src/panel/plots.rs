//! Line plots of times and strains.

use bevy_bunting::ClothDiagnosticsPlugin;
use bevy_diagnostic::{Diagnostic, DiagnosticPath, DiagnosticsStore};
use bevy_ecs::prelude::*;
use bevy_egui::egui::epaint::PathStroke;
use bevy_egui::egui::{Pos2, Rect, Sense, Ui, Vec2, pos2};

use crate::strain::ClothStrainPlugin;

/// Size of a plot, points.
const SIZE: Vec2 = Vec2::new(160.0, 24.0);

/// Width of its line, points.
const LINE: f32 = 1.0;

/// Shows the strains of the selected cloth, the time of a tick and of each of its sets, in lines from 0 to their greatest.
pub fn show_plots(world: &World, ui: &mut Ui) {
    let Some(diagnostics) = world.get_resource::<DiagnosticsStore>() else { return };
    ui.strong("Strain of the selected cloth");
    let show = |paths: &[DiagnosticPath], ui: &mut Ui| {
        paths.iter().filter_map(|path| diagnostics.get(path)).for_each(|it| plot(it, ui));
    };
    show(&[ClothStrainPlugin::GREATEST, ClothStrainPlugin::MEAN], ui);
    ui.strong("Times");
    show(&[ClothDiagnosticsPlugin::TICK], ui);
    ui.collapsing("Sets", |ui| show(&ClothDiagnosticsPlugin::SETS, ui));
}

/// Shows the last values of a diagnostic.
fn plot(diagnostic: &Diagnostic, ui: &mut Ui) {
    let values: Vec<f64> = diagnostic.values().copied().collect();
    let greatest = values.iter().copied().fold(0.0, f64::max);
    ui.horizontal(|ui| {
        let (area, _) = ui.allocate_exact_size(SIZE, Sense::hover());
        let stroke = PathStroke::new(LINE, ui.visuals().text_color());
        ui.painter().rect_filled(area, 0.0, ui.visuals().extreme_bg_color);
        ui.painter().line(points(&values, greatest, area), stroke);
        let suffix = &diagnostic.suffix;
        let last = values.last().copied().unwrap_or_default();
        let name = name(diagnostic.path());
        ui.label(format!("{name} {last:.2} {suffix}, at most {greatest:.2} {suffix}"));
    });
}

/// What a diagnostic is called beside its plot: `mean strain` for `cloth/selected/mean_strain`.
fn name(path: &DiagnosticPath) -> String {
    path.components().last().unwrap_or_default().replace('_', " ")
}

/// Points of the values in an area whose height is `greatest`, the last one at its right.
fn points(values: &[f64], greatest: f64, area: Rect) -> Vec<Pos2> {
    let apart = area.width() / values.len().saturating_sub(1).max(1) as f32;
    let height = |value: f64| {
        let part = if greatest > 0.0 { (value / greatest).clamp(0.0, 1.0) } else { 0.0 };
        area.bottom() - area.height() * part as f32
    };
    let finite = values.iter().filter(|value| value.is_finite());
    finite
        .zip(0..)
        .map(|(&value, at)| pos2(area.left() + apart * at as f32, height(value)))
        .collect()
}
