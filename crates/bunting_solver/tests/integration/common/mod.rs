//! Meshes, materials and drives that several tests use.

mod drives;
mod irregular;
mod links;
mod shells;
mod trousers;

pub use drives::{drive, material};
pub use irregular::{irregular, net};
pub use links::longest_link;
pub use shells::{free_tube, hemisphere, sphere, tube, volume};
pub use trousers::trousers;
