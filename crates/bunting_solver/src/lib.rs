//! Real-time cloth: position-based dynamics in SIMD lanes.
//!
//! This crate is the physics of `bevy_bunting`, without an ECS, a renderer or a clock. A [`Fabric`] is a piece of
//! cloth at rest: particles, triangles, constraints and pins. A [`ClothBatch`] holds the moving state of up to
//! sixteen cloths of one fabric, one in each lane of a vector, and steps them together. All units are SI.
//!
//! ```
//! use std::sync::Arc;
//! use bunting_solver::{
//!     ClothBatch, ClothSnapshot, FabricBuilder, FabricMaterial, Grid, LaneCount, StepLimits,
//! };
//!
//! // A flag of one square metre, pinned along its left edge, u = 0.
//! let grid = FabricBuilder::grid(Grid::new(17, 17, 1.0, 1.0));
//! let fabric = Arc::new(grid.pin_where(|_, uv| uv.x == 0.0).build()?);
//!
//! let mut batch = ClothBatch::new(Arc::clone(&fabric), LaneCount::One);
//! let flag = batch.insert(&ClothSnapshot::at_rest(&fabric), FabricMaterial::FLAG_POLYESTER)?;
//! for _ in 0..60 {
//!     batch.step(1.0 / 60.0, StepLimits::default());
//! }
//!
//! let mut positions = Vec::new();
//! batch.copy_positions(flag, &mut positions);
//! # let lowest = positions.iter().map(|at| at.y).fold(0.0, f32::min);
//! # assert!(positions.len() == 17 * 17 && lowest < -1.0);
//! # Ok::<(), Box<dyn core::error::Error>>(())
//! ```
//!
//! # One tick
//!
//! The loop is that of Häggström's thesis (5.1), with small steps (Macklin 2019) and compliances from the
//! material (XPBD, Macklin 2016). [`ClothBatch::step`] runs the whole loop:
//!
//! 1. [`ClothBatch::begin_tick`] sets the length of the substeps and finds contact candidates.
//! 2. In each substep
//!    1. [`ClothBatch::integrate`] carries the state into the moved frame, applies air, damping and gravity, and
//!       predicts positions;
//!    2. [`ClothBatch::solve_constraints`] projects the predictions onto bending, stretch, shear, tethers and
//!       contacts;
//!    3. [`ClothBatch::update_velocities`] computes velocities from the corrected positions.
//! 3. [`ClothBatch::compute_normals`] computes normals, once.
//!
//! Forces and constraints of the user come between the phases of a substep: see
//! [`ClothBatch::particles_mut`].
//!
//! # Schemes
//!
//! [`Scheme::Yarns`] solves all links of a straight path of the fabric at once, as a tridiagonal system, and
//! integrates by a formula of second order. [`Scheme::GaussSeidel`] is the thesis's scheme.
//!
//! # Frames
//!
//! Positions of a cloth are in the cloth's own frame, in which its pins are constant. When the frame moves, the
//! [`FrameMotion`] of the tick is applied to the free particles substep by substep. Velocities are relative to
//! the world, along the frame's axes.
//!
//! # Determinism
//!
//! The bits of a cloth's state depend on its own history only: not on the other cloths of the batch, nor on the
//! width, the instruction set or the thread.

#![cfg_attr(docsrs, feature(doc_cfg))]
#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod anchors;
mod batch;
mod constants;
mod constraints;
mod contact;
mod fabric;
mod geometry;
#[cfg(feature = "serde")]
pub mod packed;
mod pressure;
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}
mod seams;
mod simd;
mod stability;
mod step;
mod subdivision;
mod transfer;

pub use anchors::{Hold, Holder, PinGroups, PinReaction};
pub use batch::lane_count::LaneCount;
pub use batch::snapshot::ClothSnapshot;
pub use batch::{BatchError, ClothBatch, Entering, LaneSurface, ParticlesMut};
pub use contact::cloths::group::{ClothGroup, GroupLanes};
pub use contact::cloths::member::GroupMember;
pub use contact::collider::Collider;
pub use contact::itself::settings::SelfCollision;
pub use contact::lift::SurfaceLift;
pub use contact::points::{ContactPoint, Touched};
pub use contact::reaction::ContactReaction;
pub use fabric::{
    Carried, CoarserMesh, Fabric, FabricBuilder, FabricError, FabricMaterial, Grid, Link,
    LinkFamily, MaterialRegion, MeshPoint, MeshRepair, RegionError, RegionShape, Resampled,
    Resolution,
};
pub use pressure::Pressure;
pub use seams::plan::Seams;
pub use seams::stitch::{Lacing, Stitch};
pub use simd::level::{has_fused_products, instruction_set, with_every_instruction_set};
pub use step::effort::Effort;
pub use step::effort_class::{EffortCause, EffortClass};
pub use step::frame::FrameMotion;
pub use step::limits::StepLimits;
pub use step::loads::Loads;
pub use step::{Backstop, Drive, Guide, MovingPin, Scheme, StepSettings};
pub use subdivision::{Stencils, Subdivision, SubdivisionBuffers};
pub use transfer::{LevelTransfer, TransferError};
