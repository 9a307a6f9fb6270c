//! Real-time cloth for Bevy.
//!
//! Add [`ClothPlugins`], spawn an entity with a [`ClothMesh`], an [`Attachment`] to something that
//! moves, and a [`WindField`] somewhere: it flies.
//!
//! ```
//! use std::time::Duration;
//!
//! use bevy_app::prelude::*;
//! use bevy_bunting::prelude::*;
//! use bevy_math::Vec3;
//! use bevy_time::{TimePlugin, TimeUpdateStrategy};
//! use bevy_transform::prelude::*;
//!
//! let mut app = App::new();
//! app.add_plugins((TimePlugin, TransformPlugin, ClothPlugins::default()))
//!     .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f32(1.0 / 60.0)));
//!
//! app.world_mut().spawn(WindField::steady(Vec3::new(6.0, 0.0, 2.0)).with_gusts(1.5, 0.5, 1));
//! let pole = app.world_mut().spawn(Transform::from_xyz(0.0, 3.0, 0.0)).id();
//! let flag = app.world_mut().spawn((
//!     ClothMesh::grid(33, 23, 1.5, 1.0),
//!     ClothMaterial::FLAG_POLYESTER,
//!     Attachment::new(pole, ClothEdge::Left),
//! ));
//! let flag = flag.id();
//!
//! (0..60).for_each(|_| app.update());
//! let state = app.world().get::<ClothState>(flag).unwrap();
//! assert_eq!(state.positions().len(), 33 * 23);
//! ```
//!
//! # Components
//!
//! | Component | On | What it does |
//! | --- | --- | --- |
//! | [`ClothMesh`] | a cloth | its shape at rest; brings the rest along |
//! | [`ClothMaterial`] | a cloth | what it is made of |
//! | [`LodSet`] | a cloth | its levels of detail |
//! | [`Attachment`] | a cloth | holds vertices on another entity |
//! | [`ClothPaused`] | a cloth | stops it |
//! | [`ClothState`] | a cloth | positions and normals after the last tick, to be read |
//! | [`ClothSurface`] | a cloth | the same between two ticks, for display |
//! | [`WindField`] | anything | moves the air |
//! | [`ClothCollider`] | anything | a shape that cloth does not enter |
//! | [`LodViewer`] | a camera | what levels of detail look to |
//!
//! [`ClothSettings`] holds gravity, the density of air and how finely each level is solved;
//! [`ClothBudget`] how much time cloths with [`LodSet::automatic`] may take, and [`LodReport`] what
//! was made of it.
//!
//! A cloth at rest is asleep, and so is one with [`LodSet::automatic`] that no [`LodViewer`] sees:
//! [`ClothState::activity`] tells.
//!
//! # Sets
//!
//! A tick is one fixed step: the schedule [`ClothTick`], run in `FixedPostUpdate` unless
//! [`ClothPlugins::new`] says otherwise.
//!
//! | [`ClothSystems`] | What happens |
//! | --- | --- |
//! | [`Prepare`](ClothSystems::Prepare) | new, changed and removed cloths; wind |
//! | [`SelectLod`](ClothSystems::SelectLod) | levels of detail; every cloth takes its lane |
//! | [`Drive`](ClothSystems::Drive) | how frames move, gravity, wind, colliders |
//! | [`Step`](ClothSystems::Step) | runs [`ClothSubstep`], see below |
//! | [`Normals`](ClothSystems::Normals) | normals, once |
//! | [`Publish`](ClothSystems::Publish) | [`ClothState`], transforms of attached cloths |
//!
//! | [`ClothSubstepSystems`] | What happens |
//! | --- | --- |
//! | [`Integrate`](ClothSubstepSystems::Integrate) | frame motion, external forces, prediction |
//! | [`SolveConstraints`](ClothSubstepSystems::SolveConstraints) | constraints and contacts |
//! | [`UpdateVelocities`](ClothSubstepSystems::UpdateVelocities) | velocities from positions |
//!
//! # Events
//!
//! [`ClothFailed`], [`ClothLevelChanged`] and [`ClothTargetLost`] are triggered on the cloth;
//! [`TeleportCloth`] is for you to trigger.
//!
//! # Drawing
//!
//! With the feature `render`, a cloth with a material is drawn: `ClothRenderPlugin` gives it a mesh
//! for each level, keeps its bounds, and puts a [`LodViewer`] on cameras. Its documentation tells
//! what the material should be like. `ClothDebugPlugin`, to be added, draws gizmos.
//!
//! # Determinism
//!
//! The same world, stepped alike, gives the same bits: they depend neither on what else is in the
//! world, nor on the number of threads. Only [`LodSet::automatic`] shares a budget among all cloths,
//! and by default measures what they cost; with [`LodCosts::Fixed`] it, too, chooses alike on every
//! machine.

mod batch;
mod cloth;
mod diagnostics;
mod display;
mod environment;
mod fabric;
mod lod;
mod motion;
#[cfg(feature = "render")]
mod render;
mod schedule;
mod settings;

use bevy_app::{FixedPostUpdate, PluginGroup, PluginGroupBuilder};
use bevy_ecs::intern::Interned;
use bevy_ecs::schedule::ScheduleLabel;

pub use batch::assign::SeatPlugin;
pub use batch::batches::ClothBatches;
pub use batch::publish::PublishPlugin;
pub use batch::solve::SolverPlugin;
pub use bunting_solver;
pub use cloth::activity::ClothActivity;
pub use cloth::error::{ClothError, ClothFailed};
pub use cloth::imperfection::ClothSeed;
pub use cloth::mesh::{ClothMaterial, ClothMesh, ClothPaused};
pub use cloth::preroll::{ClothPreroll, PrerollPlugin};
pub use cloth::state::ClothState;
pub use diagnostics::{ClothCounts, ClothDiagnosticsPlugin, ClothTimings};
pub use display::easing::EasingPlugin;
pub use display::surface::{ClothSurface, SurfacePlugin};
pub use environment::collider::{ClothCollider, ColliderPlugin};
pub use environment::drive::DrivePlugin;
pub use environment::wind::{TickWind, WindField, WindPlugin};
pub use fabric::part::WeightsError;
pub use fabric::prepare::{ClothTargetLost, PreparePlugin};
pub use lod::sleep::RestPlugin;
pub use lod::{
    ClothBudget, ClothLevelChanged, CostTable, Lens, LodChoice, LodCosts, LodPlugin, LodReport,
    LodSet, LodViewer,
};
pub use motion::attachment::{AttachedVertices, Attachment, ClothCorner, ClothEdge, TargetLost};
pub use motion::frame::AttachmentPlugin;
pub use motion::teleport::{TeleportCloth, TeleportMode, TeleportPlugin};
pub use parry3d;
#[cfg(feature = "render")]
pub use render::{ClothDebugPlugin, ClothGizmos, ClothRenderPlugin, ClothRenderSystems};
pub use schedule::{
    ClothSubstep, ClothSubstepSystems, ClothSystems, ClothTick, SchedulePlugin, run_cloth_tick,
};
pub use settings::ClothSettings;

/// Everything that one usually needs.
pub mod prelude {
    pub use crate::{
        AttachedVertices, Attachment, ClothActivity, ClothBudget, ClothCollider, ClothCorner,
        ClothEdge, ClothError, ClothFailed, ClothLevelChanged, ClothMaterial, ClothMesh,
        ClothPaused, ClothPlugins, ClothPreroll, ClothSeed, ClothSettings, ClothState, ClothSurface,
        ClothSystems, ClothTargetLost, ClothTick, LodSet, LodViewer, TargetLost, TeleportCloth,
        TeleportMode, WeightsError, WindField,
    };
    pub use bunting_solver::{FabricMaterial, StepLimits, StepSettings};
}

/// All plugins that cloth needs, one a concern.
///
/// Bevy's `TimePlugin` and `TransformPlugin` must be there, too, as they are in `DefaultPlugins`.
#[derive(Debug)]
pub struct ClothPlugins {
    host: Interned<dyn ScheduleLabel>,
}

impl ClothPlugins {
    /// Cloth that ticks in the given schedule.
    #[must_use]
    pub fn new(schedule: impl ScheduleLabel) -> Self {
        Self { host: schedule.intern() }
    }
}

impl Default for ClothPlugins {
    /// Cloth that ticks in `FixedPostUpdate`.
    fn default() -> Self {
        Self::new(FixedPostUpdate)
    }
}

impl PluginGroup for ClothPlugins {
    fn build(self) -> PluginGroupBuilder {
        let group = PluginGroupBuilder::start::<Self>()
            .add(SchedulePlugin::new(self.host))
            .add(PreparePlugin)
            .add(LodPlugin)
            .add(RestPlugin)
            .add(PrerollPlugin)
            .add(SeatPlugin)
            .add(WindPlugin)
            .add(AttachmentPlugin)
            .add(TeleportPlugin)
            .add(DrivePlugin)
            .add(ColliderPlugin)
            .add(SolverPlugin)
            .add(PublishPlugin)
            .add(EasingPlugin)
            .add(SurfacePlugin)
            .add(ClothDiagnosticsPlugin);
        #[cfg(feature = "render")]
        let group = group.add(ClothRenderPlugin);
        group
    }
}
