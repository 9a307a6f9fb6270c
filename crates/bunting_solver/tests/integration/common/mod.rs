//! Meshes, materials and drives that several tests use.

mod drives;
mod irregular;
mod trousers;

pub use drives::{drive, material};
pub use irregular::{irregular, net};
pub use trousers::trousers;
