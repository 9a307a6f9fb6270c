//! Batches: the state of cloths of one fabric, or of one topology, in the lanes of vectors.

mod cloth_batch;
mod error;
pub(crate) mod exchange;
mod grouped;
pub(crate) mod lane_batch;
pub(crate) mod lane_count;
pub(crate) mod lane_fabric;
pub(crate) mod lane_state;
pub(crate) mod layout;
mod layout_of_scheme;
mod loads;
mod masses;
pub(crate) mod mixed;
mod particles_mut;
pub(crate) mod probe_motion;
mod readout;
pub(crate) mod side_by_side;
pub(crate) mod single_cloth;
pub(crate) mod single_net;
mod single_tethers;
pub(crate) mod snapshot;
mod surfaces;
mod surroundings;
mod tether_pack;
mod unused_fabrics;

pub use cloth_batch::ClothBatch;
pub use error::BatchError;
pub use exchange::Entering;
pub use particles_mut::ParticlesMut;
pub use surfaces::LaneSurface;
