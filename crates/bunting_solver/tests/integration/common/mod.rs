//! Meshes, materials and drives that several tests use.

mod drives;
mod irregular;
mod shells;
mod trousers;

pub use drives::{drive, material};
pub use irregular::{irregular, net};
pub use shells::{hemisphere, sphere, tube, volume};
pub use trousers::trousers;
