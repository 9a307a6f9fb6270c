//! Real-time cloth: position-based dynamics in SIMD lanes.
//!
//! This crate is the physics of `bevy_bunting`. It knows no ECS, no renderer and no clock: it takes
//! a [`Fabric`] (a cloth at rest), fills the lanes of a [`ClothBatch`] with cloths cut from it, and
//! steps them.
//!
//! # One tick
//!
//! The loop of Häggström's thesis (5.1), with small steps (Macklin 2019) and compliance from the
//! material (XPBD, Macklin 2016):
//!
//! 1. [`ClothBatch::begin_tick`]: compliances for the step, contact candidates.
//! 2. For each substep:
//!    1. [`ClothBatch::integrate`]: carry the state into the moved frame, external forces (gravity,
//!       air), damping, prediction.
//!    2. [`ClothBatch::solve_constraints`]: bending, stretch and shear, contacts.
//!    3. [`ClothBatch::update_velocities`]: velocities from the corrected positions.
//! 3. [`ClothBatch::compute_normals`], once.
//!
//! [`ClothBatch::step`] does all of it.
//!
//! # Frames
//!
//! A cloth lives in its own frame: pinned particles are constants there. When the frame moves, the
//! [`FrameMotion`] of the tick is fed to the free particles over the substeps. Velocities are the
//! world's, along the frame's axes.
//!
//! # Determinism
//!
//! A lane's bits depend on its own history only: not on the lanes beside it, the width, the
//! instruction set, nor the thread.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod batch;
mod constants;
mod constraints;
mod contact;
mod fabric;
mod geometry;
mod simd;
mod stability;
mod step;
mod transfer;

pub use batch::lane_count::LaneCount;
pub use batch::snapshot::ClothSnapshot;
pub use batch::{BatchError, ClothBatch, LaneSurface};
pub use contact::collider::Collider;
pub use fabric::{
    CoarserMesh, Fabric, FabricBuilder, FabricError, FabricMaterial, Grid, Link, LinkFamily,
};
pub use simd::level::{instruction_set, with_every_instruction_set};
pub use step::frame::FrameMotion;
pub use step::limits::StepLimits;
pub use step::{Drive, Scheme, StepSettings};
pub use transfer::{LevelTransfer, TransferError};
