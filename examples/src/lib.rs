//! Examples of `bevy_bunting` live beside this file, one folder each.

/// The README, whose example is tested here.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
pub struct Readme;
