//! The panel.

mod brush;
mod cloths;
mod files;
mod plots;
pub mod plugin;
pub mod state;
pub mod window;
