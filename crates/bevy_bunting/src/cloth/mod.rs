//! A cloth: its mesh, material and state, and what can be wrong with them.

pub mod activity;
pub mod error;
pub mod events;
pub mod imperfection;
pub mod instance;
pub mod material;
pub mod mesh;
mod missing_plugins;
pub mod place;
pub mod preroll;
pub mod reflect;
pub mod regions;
pub mod resolution;
pub mod restored;
pub mod state;
pub mod weights;
