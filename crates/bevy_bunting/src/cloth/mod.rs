//! What a cloth is: its mesh, its material, its state.

pub mod activity;
pub mod error;
pub mod imperfection;
pub mod instance;
pub mod mesh;
pub mod preroll;
pub mod reflect;
pub mod state;
