//! Where the state of cloths lives: the lanes of a batch.

mod cloth_batch;
pub(crate) mod lane_batch;
pub(crate) mod lane_count;
pub(crate) mod layout;
pub(crate) mod places;
mod readout;
pub(crate) mod single_cloth;
pub(crate) mod snapshot;
mod surfaces;

pub use cloth_batch::{BatchError, ClothBatch, LaneSurface};
