//! Scenes shared by the examples, the tests and the lab of bevy_bunting.

mod check;
mod error;
mod key;
mod load;
mod material;
mod scene;
mod spawn;
mod track;

pub use error::SceneError;
pub use load::{load, parse};
pub use material::{MaterialRecipe, PRESETS, preset};
pub use scene::{Design, Flag, Footing, Levels, Route, Scene, Vehicle, Viewer, Wind};
pub use spawn::{Model, Pole, spawn};
pub use track::{LooksAt, Track, follow_tracks};
