//! A panel that shows and tunes the cloth of [`bevy_bunting`] while it flies, and files of its parameters.
//!
//! Add [`ClothInspectorPlugin`] besides `DefaultPlugins` and [`ClothPlugins`](bevy_bunting::ClothPlugins): a window in the
//! window lists the cloths, and shows the parameters of the selected one, of the winds and of all cloths. Everything in it
//! can be had without it:
//!
//! | Item | What it does |
//! | --- | --- |
//! | [`SelectedCloth`], [`ClothSelectionPlugin`] | the cloth that is tuned, selected by a click |
//! | [`save_tuning`], [`load_tuning`] | the parameters of a cloth, the winds and all cloths in a file of RON |
//! | [`PRESETS`] | materials by name |
//! | [`ClothStrainPlugin`] | strain of the selected cloth, in Bevy's diagnostics |
//! | [`cloth_panel`] | the content of the panel, in any `Ui` of egui |
//!
//! With the feature `window` (default) the panel is drawn by Bevy's renderer. Without it the crate needs no renderer.

#![cfg_attr(docsrs, feature(doc_cfg))]

#[cfg(doctest)]
#[doc = include_str!("../../../docs/guide/tuning.md")]
mod guide {}
mod panel;
mod parameters;
mod presets;
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}
mod selection;
mod strain;
mod tuning;

pub use bevy_egui;
pub use panel::plugin::ClothInspectorPlugin;
pub use panel::state::PanelState;
pub use panel::window::cloth_panel;
pub use presets::PRESETS;
pub use selection::{ClothSelectionPlugin, SelectedCloth};
pub use strain::ClothStrainPlugin;
pub use tuning::error::{TuningError, TuningProblem};
pub use tuning::load::load_tuning;
pub use tuning::save::save_tuning;
