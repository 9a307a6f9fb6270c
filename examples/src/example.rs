//! The interface of an example.

use bevy::ecs::schedule::ScheduleLabel;
use bevy::prelude::*;

#[cfg(feature = "render")]
use crate::render::stage::Stage;

/// A scene of cloth: its entities, its measurements and, with the feature `render`, its look.
pub trait Example {
    /// Title of the window, and the start of the names of pictures.
    const NAME: &'static str;

    /// Simulated time of a headless run unless the command line sets it, s.
    const SECONDS: f64;

    /// Spawns cloths, winds and one `LodViewer`, and adds the systems that move them to `schedule`. In a
    /// headless run this is `FixedUpdate`, which makes the bits reproducible; in a window it is `Update`,
    /// which makes motion smooth at any frame rate.
    fn build(&self, app: &mut App, schedule: impl ScheduleLabel);

    /// An empty record of a headless run with this number of ticks per second.
    fn record(&self, ticks_per_second: usize) -> impl Record;

    /// Sky, ground and light.
    #[cfg(feature = "render")]
    fn stage(&self) -> Stage;

    /// Adds the plugins that give meshes and materials to the entities of [`build`](Self::build).
    #[cfg(feature = "render")]
    fn draw(&self, app: &mut App);

    /// Adds the controls of a window: a camera that the mouse moves, and keys.
    #[cfg(feature = "render")]
    fn control(&self, app: &mut App);
}

/// Measurements of a headless run.
pub trait Record {
    /// Adds the tick that has just been simulated. Returns a line to print at once, if any.
    fn add_tick(&mut self, world: &mut World) -> Option<String>;

    /// Prints all measurements. Returns whether every measured value is within its limit.
    fn print(&self) -> bool;
}
