//! What the examples of `bevy_bunting` share; they live beside this folder, one folder each.

pub mod durations;
pub mod headless;
pub mod keys;
pub mod orbit;
pub mod pictures;
pub mod print;
pub mod show;
pub mod sky;
pub mod stage;
pub mod strain;
pub mod title;
pub mod weather;

use bevy::time::TimeUpdateStrategy;

/// Scenes and models.
pub const ASSETS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../assets");

/// One tick a frame, whatever the wall clock says.
pub const ONE_TICK: TimeUpdateStrategy = TimeUpdateStrategy::FixedTimesteps(1);

/// Whether a window could be opened: winit panics where none can.
#[must_use]
pub fn any_display() -> bool {
    !cfg!(target_os = "linux") || x11rb::connect(None).is_ok()
}

/// The README, whose example is tested here.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
pub struct Readme;
