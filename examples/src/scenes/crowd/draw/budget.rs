//! Keys that change the budget of all cloths.

use std::time::Duration;

use crate::render::title::Title;
use bevy::prelude::*;
use bevy_bunting::LodReport;
use bevy_bunting::prelude::*;

/// Factor of the budget for one press of a key.
const STEP: f32 = 1.25;

/// Least and greatest budget, ms.
const BUDGETS: (f32, f32) = (0.1, 20.0);

/// The arrows up and down increase and reduce the budget, which the title shows.
pub fn plugin(app: &mut App) {
    app.add_systems(Update, (read_keys, write_note));
    Title::add_keys(app, "↑ ↓: budget");
}

fn read_keys(keys: Res<ButtonInput<KeyCode>>, mut budget: ResMut<ClothBudget>) {
    for (key, factor) in [(KeyCode::ArrowUp, STEP), (KeyCode::ArrowDown, STEP.recip())] {
        if keys.just_pressed(key) {
            let milliseconds = factor * budget.tick.as_secs_f32() * 1e3;
            let milliseconds = milliseconds.clamp(BUDGETS.0, BUDGETS.1);
            budget.tick = Duration::from_secs_f32(1e-3 * milliseconds);
        }
    }
}

fn write_note(budget: Res<ClothBudget>, report: Res<LodReport>, mut title: ResMut<Title>) {
    let milliseconds = budget.tick.as_secs_f32() * 1e3;
    title.note = format!("asleep: {} | budget {milliseconds:.2} ms", report.asleep());
}
