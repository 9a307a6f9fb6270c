//! Code shared by the examples of `bevy_bunting`, which live beside this folder, one folder each.
//!
//! An [`Example`] is simulated by [`headless`] and, with the feature `render`, drawn by `render`.

pub mod durations;
mod example;
pub mod headless;
pub mod limits;
#[cfg(feature = "render")]
pub mod render;
pub mod strain;
pub mod table;

pub use example::{Example, Options, Record};

/// Folder of scenes and models.
pub const ASSETS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../assets");

/// The README, whose example is tested here.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
pub struct Readme;
