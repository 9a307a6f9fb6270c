//! The panel.

mod brush;
mod cloths;
mod components;
mod files;
mod plots;
pub mod plugin;
pub mod state;
mod units;
pub mod window;
