//! Snapshots of cloths: taken between two ticks, written as bytes, and restored, after which cloth goes on with the same bits.

pub mod apply;
#[cfg(feature = "serialize")]
pub mod bytes;
pub mod check;
pub mod clocks;
pub mod cloth;
#[cfg(feature = "serialize")]
pub mod entity_bits;
pub mod error;
pub mod lanes;
pub mod others;
pub mod plugin;
pub mod saves;
pub mod surface;
pub mod take;
pub mod world;
