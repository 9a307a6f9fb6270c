//! Keys, and what the window's title tells.

use std::time::Duration;

use bevy::diagnostic::{DiagnosticPath, DiagnosticsStore, FrameTimeDiagnosticsPlugin};
use bevy::prelude::*;
use bevy::time::common_conditions::on_real_timer;
use bevy::window::PrimaryWindow;
use bevy_bunting::prelude::*;
use bevy_bunting::{ClothCounts, ClothDiagnosticsPlugin, LodReport};

use crate::colours::ByLevel;

/// How many times more time the cloths get by one press of a key.
const STEP: f32 = 1.25;

/// Least and most time that they can be given, ms.
const BUDGETS: (f32, f32) = (0.1, 20.0);

/// Time between two titles.
const PERIOD: Duration = Duration::from_millis(500);

/// Listens, and tells.
pub fn plugin(app: &mut App) {
    app.add_plugins(FrameTimeDiagnosticsPlugin::default())
        .add_systems(Update, (listen, tell.run_if(on_real_timer(PERIOD))));
}

fn listen(
    keys: Res<ButtonInput<KeyCode>>,
    mut budget: ResMut<ClothBudget>,
    mut by_level: ResMut<ByLevel>,
    mut time: ResMut<Time<Virtual>>,
) {
    let factor = match () {
        () if keys.just_pressed(KeyCode::ArrowUp) => STEP,
        () if keys.just_pressed(KeyCode::ArrowDown) => STEP.recip(),
        () => 1.0,
    };
    if factor != 1.0 {
        let milliseconds = factor * budget.tick.as_secs_f32() * 1e3;
        let milliseconds = milliseconds.clamp(BUDGETS.0, BUDGETS.1);
        budget.tick = Duration::from_secs_f32(1e-3 * milliseconds);
    }
    if keys.just_pressed(KeyCode::KeyL) {
        by_level.0 = !by_level.0;
    }
    if keys.just_pressed(KeyCode::KeyP) {
        if time.is_paused() {
            time.unpause();
        } else {
            time.pause();
        }
    }
}

fn tell(
    mut window: Single<&mut Window, With<PrimaryWindow>>,
    diagnostics: Res<DiagnosticsStore>,
    counts: Res<ClothCounts>,
    report: Res<LodReport>,
    budget: Res<ClothBudget>,
) {
    let mean =
        |path: &DiagnosticPath| diagnostics.get(path).and_then(|measured| measured.average());
    let tick = mean(&ClothDiagnosticsPlugin::TICK).unwrap_or_default();
    let frame = mean(&FrameTimeDiagnosticsPlugin::FRAME_TIME).unwrap_or_default();
    let levels: Vec<String> = counts.0.iter().map(ToString::to_string).collect();
    window.title = format!(
        "Crowd | {frame:.1} ms a frame, cloth {tick:.2} of {:.2} ms a tick | by level: {}, asleep: {} | ↑ ↓: budget, L: levels, P: pause",
        budget.tick.as_secs_f32() * 1e3,
        levels.join(" "),
        report.asleep(),
    );
}
