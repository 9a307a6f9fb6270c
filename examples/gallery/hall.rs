//! Adds the gallery's keys to an example.

use std::num::NonZero;

use bevy::ecs::schedule::ScheduleLabel;
use bevy::prelude::*;
use bunting_examples::render::stage::Stage;
use bunting_examples::render::title::Title;
use bunting_examples::{Example, Record};

use crate::exit::{NEXT, PREVIOUS};

/// An example, with keys that leave it for another one.
pub struct Hall<'e, E>(pub &'e E);

impl<E: Example> Example for Hall<'_, E> {
    const NAME: &'static str = E::NAME;
    const SECONDS: f64 = E::SECONDS;

    fn build(&self, app: &mut App, schedule: impl ScheduleLabel) {
        self.0.build(app, schedule);
    }

    fn record(&self, ticks_per_second: usize) -> impl Record {
        self.0.record(ticks_per_second)
    }

    fn stage(&self) -> Stage {
        self.0.stage()
    }

    fn draw(&self, app: &mut App) {
        self.0.draw(app);
    }

    fn control(&self, app: &mut App) {
        self.0.control(app);
        app.add_systems(Update, leave);
        #[cfg(target_arch = "wasm32")]
        app.add_systems(Last, crate::address::follow);
        Title::add_keys(app, "← →: other examples");
    }
}

/// Ends the app with the exit code of the key that is pressed.
fn leave(keys: Res<ButtonInput<KeyCode>>, mut exits: MessageWriter<AppExit>) {
    for (key, code) in [(KeyCode::ArrowRight, NEXT), (KeyCode::ArrowLeft, PREVIOUS)] {
        if keys.just_pressed(key) {
            exits.write(NonZero::new(code).map_or(AppExit::Success, AppExit::Error));
        }
    }
}
