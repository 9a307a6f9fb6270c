//! Timings and keys in the title of the window.

use std::time::Duration;

use bevy::diagnostic::{DiagnosticPath, DiagnosticsStore, FrameTimeDiagnosticsPlugin};
use bevy::prelude::*;
use bevy::time::common_conditions::on_real_timer;
use bevy::window::PrimaryWindow;
use bevy_bunting::{ClothCounts, ClothDiagnosticsPlugin};

/// Time between two updates of the title.
const PERIOD: Duration = Duration::from_millis(500);

/// The parts of the title other than timings.
#[derive(Resource, Debug)]
pub struct Title {
    name: &'static str,
    /// State of the example's own controls.
    pub note: String,
    keys: Vec<&'static str>,
}

impl Title {
    /// Adds a description of keys to the title; needs [`plugin`].
    pub fn add_keys(app: &mut App, keys: &'static str) {
        app.world_mut().resource_mut::<Self>().keys.push(keys);
    }
}

/// Keeps the title of the window up to date.
pub fn plugin(name: &'static str) -> impl Plugin {
    move |app: &mut App| {
        app.add_plugins(FrameTimeDiagnosticsPlugin::default())
            .insert_resource(Title { name, note: String::new(), keys: vec!["P: pause"] })
            .add_systems(Update, write_title.run_if(on_real_timer(PERIOD)));
    }
}

fn write_title(
    mut window: Single<&mut Window, With<PrimaryWindow>>,
    diagnostics: Res<DiagnosticsStore>,
    counts: Res<ClothCounts>,
    time: Res<Time<Virtual>>,
    title: Res<Title>,
) {
    let mean =
        |path: &DiagnosticPath| diagnostics.get(path).and_then(|measured| measured.average());
    let frame = mean(&FrameTimeDiagnosticsPlugin::FRAME_TIME).unwrap_or_default();
    let tick = mean(&ClothDiagnosticsPlugin::TICK).unwrap_or_default();
    let levels: Vec<String> = counts.0.iter().map(ToString::to_string).collect();
    window.title = format!(
        "{}, {:.1} s | {frame:.1} ms a frame, cloth {tick:.3} ms a tick | cloths by level: {} | {} | {}",
        title.name,
        time.elapsed_secs(),
        levels.join(" "),
        title.note,
        title.keys.join(", "),
    );
}
