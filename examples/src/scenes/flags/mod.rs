//! Eight flags, two of them on driving vehicles, in gusty wind.

#[cfg(feature = "render")]
mod draw;
mod measurements;
mod record;
mod table;

use bevy::ecs::schedule::ScheduleLabel;
use bevy::prelude::*;
use bunting_scenes::{Scene, SceneError};

use crate::scenes::flags::record::FlagsRecord;
use crate::{ASSETS, Example, Record};

/// A scene of flags from a file.
#[derive(Debug)]
pub struct Flags(pub Scene);

impl Flags {
    /// The scene `assets/scenes/flags.ron`; in browsers, which have no files, as it was when this was compiled.
    ///
    /// # Errors
    ///
    /// If the file cannot be read.
    pub fn load() -> Result<Self, SceneError> {
        let file = format!("{ASSETS}/scenes/flags.ron");
        let scene = if cfg!(target_arch = "wasm32") {
            let source = include_str!("../../../../assets/scenes/flags.ron");
            bunting_scenes::parse(source, file.as_ref())
        } else {
            bunting_scenes::load(file)
        };
        scene.map(Self)
    }
}

impl Example for Flags {
    const NAME: &'static str = "Flags";
    const SECONDS: f64 = 20.0;

    fn build(&self, app: &mut App, schedule: impl ScheduleLabel) {
        app.add_systems(schedule, bunting_scenes::follow_tracks);
        bunting_scenes::spawn(&mut app.world_mut().commands(), &self.0);
    }

    fn record(&self, ticks_per_second: usize) -> impl Record {
        FlagsRecord::new(&self.0, ticks_per_second)
    }

    #[cfg(feature = "render")]
    fn stage(&self) -> crate::render::stage::Stage {
        draw::STAGE
    }

    #[cfg(feature = "render")]
    fn draw(&self, app: &mut App) {
        app.add_plugins(draw::plugin);
    }

    #[cfg(feature = "render")]
    fn control(&self, app: &mut App) {
        draw::control(app, self.0.viewer.looks_at);
    }
}
