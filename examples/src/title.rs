//! Timings and keys in the window's title.

use std::time::Duration;

use bevy::diagnostic::{DiagnosticPath, DiagnosticsStore, FrameTimeDiagnosticsPlugin};
use bevy::prelude::*;
use bevy::time::common_conditions::on_real_timer;
use bevy::window::PrimaryWindow;
use bevy_bunting::{ClothCounts, ClothDiagnosticsPlugin};

use crate::keys;
use crate::weather::Weather;

/// Time between two titles.
const PERIOD: Duration = Duration::from_millis(500);

/// What the title begins with.
#[derive(Resource, Debug)]
struct Name(&'static str);

/// Keeps the title of the window up to date.
pub fn plugin(name: &'static str) -> impl Plugin {
    move |app: &mut App| {
        app.add_plugins(FrameTimeDiagnosticsPlugin::default())
            .insert_resource(Name(name))
            .add_systems(Update, write.run_if(on_real_timer(PERIOD)));
    }
}

fn write(
    mut window: Single<&mut Window, With<PrimaryWindow>>,
    diagnostics: Res<DiagnosticsStore>,
    counts: Res<ClothCounts>,
    weather: Res<Weather>,
    name: Res<Name>,
) {
    let mean =
        |path: &DiagnosticPath| diagnostics.get(path).and_then(|measured| measured.average());
    let frame = mean(&FrameTimeDiagnosticsPlugin::FRAME_TIME).unwrap_or_default();
    let tick = mean(&ClothDiagnosticsPlugin::TICK).unwrap_or_default();
    let levels: Vec<String> = counts.0.iter().map(ToString::to_string).collect();
    window.title = format!(
        "{} | {frame:.1} ms a frame, cloth {tick:.3} ms a tick | cloths by level: {} | wind × {:.2} | {}",
        name.0,
        levels.join(" "),
        weather.factor(),
        keys::HELP,
    );
}
