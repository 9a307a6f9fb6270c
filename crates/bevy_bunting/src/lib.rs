//! Real-time cloth for Bevy.
//!
//! Add [`ClothPlugins`], spawn an entity with a [`ClothMesh`] and an [`Attachment`] to an entity that
//! moves, and another one with a [`WindField`]: the cloth flies.
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
//! | [`ClothMesh`] | a cloth | shape at rest; requires the components that a cloth needs |
//! | [`ClothResolution`] | a cloth | how finely a mesh that is no grid is simulated, whatever its triangles |
//! | [`ClothMaterial`] | a cloth | area density, stiffnesses, damping, friction |
//! | [`ClothRegions`] | a cloth | where its material differs: hems, battens, patches |
//! | [`LodSet`] | a cloth | levels of detail |
//! | [`Attachment`] | a cloth | holds vertices on another entity |
//! | [`ClothPaused`] | a cloth | stops the simulation of the cloth |
//! | [`ClothState`] | a cloth | positions and normals after the last tick, to be read |
//! | [`ClothSurface`] | a cloth | positions and normals between two ticks, for display |
//! | [`ClothSeams`] | a cloth | its edges that are sewn together |
//! | [`ClothSkin`] | a cloth | the joints of a skeleton that lead it |
//! | [`SkinLimits`] | a cloth | how far it may go from where its skeleton would have it |
//! | [`WindInfluence`] | a cloth | the part of the wind that it feels |
//! | [`WindPerParticle`] | a cloth | it feels the wind at each of its particles |
//! | [`ClothInertia`] | a cloth | the part of its frame's acceleration that it feels |
//! | [`ClothAcceleration`] | a cloth | an acceleration besides gravity |
//! | [`WindField`] | any entity | velocity of the air, with gusts |
//! | [`WindRegion`] | a `WindField` | the space in which it blows |
//! | [`WindFan`], [`WindBlast`], [`WindWake`] | any entity | a jet, a blast, a wake behind the entity |
//! | [`ClothCollider`] | any entity | a shape that cloth does not enter |
//! | [`LodViewer`] | a camera | a viewer in whose picture errors of levels are measured |
//!
//! The resource [`ClothSettings`] holds gravity, the density of air and the numbers of substeps and passes;
//! [`ClothBudget`] holds the time that cloths with [`LodSet::automatic`] may take, and [`LodReport`] the
//! results of the choice of levels within it.
//!
//! Cloths that have come to rest sleep, and so do cloths with [`LodSet::automatic`] that no
//! [`LodViewer`] sees, see [`ClothState::activity`].
//!
//! # Sets
//!
//! A tick is one fixed step: the schedule [`ClothTick`], run in `FixedPostUpdate` unless
//! [`ClothPlugins::new`] says otherwise.
//!
//! | [`ClothSystems`] | What happens |
//! | --- | --- |
//! | [`Prepare`](ClothSystems::Prepare) | new, changed and removed cloths; wind |
//! | [`SelectLod`](ClothSystems::SelectLod) | levels of detail; every simulated cloth gets a lane |
//! | [`Drive`](ClothSystems::Drive) | motion of frames, gravity, wind, colliders |
//! | [`Step`](ClothSystems::Step) | runs [`ClothSubstep`], see below |
//! | [`Normals`](ClothSystems::Normals) | normals, once |
//! | [`Publish`](ClothSystems::Publish) | [`ClothState`], transforms of attached cloths |
//!
//! | [`ClothSubstepSystems`] | What happens |
//! | --- | --- |
//! | [`Integrate`](ClothSubstepSystems::Integrate) | frame motion, external forces, prediction |
//! | [`UserForces`](ClothSubstepSystems::UserForces) | forces of the user, see [`ClothParticles`] |
//! | [`SolveConstraints`](ClothSubstepSystems::SolveConstraints) | constraints and contacts |
//! | [`UserConstraints`](ClothSubstepSystems::UserConstraints) | constraints of the user |
//! | [`UpdateVelocities`](ClothSubstepSystems::UpdateVelocities) | velocities from positions |
//!
//! # Events
//!
//! [`ClothFailed`], [`ClothLevelChanged`], [`ClothTargetLost`], [`ClothSeamClosed`] and [`ClothSeamOpened`] are triggered on the cloth;
//! [`TeleportCloth`], [`WakeCloth`], [`ClothImpulse`] and [`ShiftOrigin`] are triggered by the user. The system parameter [`ClothControl`]
//! moves single particles between ticks; [`ClothSpatialQuery`] finds cloths by rays, points and shapes.
//!
//! # Drawing
//!
//! With the feature `render`, a cloth with a material is drawn: `ClothRenderPlugin` gives it a mesh
//! for each level, updates its bounds, and puts a [`LodViewer`] on cameras. Its documentation says which
//! settings the material needs. With the feature `weave`, `WovenMaterial` is one that shows threads. `ClothDebugPlugin`, which is not among [`ClothPlugins`], draws gizmos.
//!
//! # Saving
//!
//! [`ClothSaves`] takes and restores [`ClothSnapshot`]s of single cloths and [`ClothWorldSnapshot`]s of all, between any two
//! ticks: for saved games, servers and rollback. Cloth goes on with the same bits. With the feature `serialize` they are
//! written as bytes.
//!
//! # Determinism
//!
//! The same world in the same ticks gives the same bits, whatever the number of threads. The bits of a cloth depend on those
//! of other cloths only where it touches them. What other cloths need has a part in its substeps, unless
//! [`ClothSettings::share_batches`] is off, and in its level with [`LodSet::automatic`], which shares a budget among all
//! cloths and by default measures their costs; with [`LodCosts::Fixed`] its choice, too, is the same on every machine.

#![cfg_attr(docsrs, feature(doc_cfg))]

mod anchors;
mod background;
mod batch;
mod cloth;
#[cfg(feature = "serialize")]
mod complete_reader;
mod diagnostics;
mod display;
mod environment;
mod fabric;
#[cfg(feature = "gltf")]
mod gltf;
#[cfg(doctest)]
mod guide;
mod lod;
mod motion;
#[cfg(feature = "picking")]
mod picking;
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}
#[cfg(feature = "render")]
mod render;
mod save;
mod schedule;
mod seams;
mod settings;
mod skeleton;
mod spatial;
mod timings;
mod waves;

use bevy_app::{FixedPostUpdate, PluginGroup, PluginGroupBuilder};
use bevy_ecs::intern::Interned;
use bevy_ecs::schedule::ScheduleLabel;

pub use anchors::grab::{ClothGrab, Grabbed, GrabbedVertices};
pub use anchors::plugin::AnchorPlugin;
pub use anchors::reactions::{AnchorReaction, AnchorReactions};
pub use batch::assign::LanePlugin;
pub use batch::batches::ClothBatches;
pub use batch::particles::{ClothParticles, SubstepParticles};
pub use batch::publish::PublishPlugin;
pub use batch::solve::SolverPlugin;
pub use bunting_solver;
pub use cloth::activity::{ClothActivity, ClothPaused};
pub use cloth::error::{ClothError, NumberRule};
pub use cloth::events::{ClothAnchorBroke, ClothFailed, ClothLevelChanged, ClothTargetLost};
pub use cloth::imperfection::ClothSeed;
pub use cloth::material::ClothMaterial;
pub use cloth::mesh::ClothMesh;
pub use cloth::preroll::{ClothPreroll, PrerollPlugin};
pub use cloth::regions::ClothRegions;
pub use cloth::resolution::ClothResolution;
pub use cloth::state::ClothState;
pub use cloth::weights::WeightsError;
#[cfg(feature = "serialize")]
pub use complete_reader::CompleteReader;
pub use diagnostics::ClothDiagnosticsPlugin;
pub use display::ease::EasingPlugin;
pub use display::lift::LiftPlugin;
pub use display::surface::{ClothSurface, SurfacePlugin};
pub use environment::cloth_collision::ClothCollision;
pub use environment::collider::{ClothCollider, ColliderError};
pub use environment::drive::DrivePlugin;
pub use environment::drive_colliders::ColliderPlugin;
pub use environment::drive_pressures::PressurePlugin;
pub use environment::drive_self_collisions::SelfCollisionPlugin;
pub use environment::forces::acceleration::ClothAcceleration;
pub use environment::forces::control::{ClothControl, ControlError, ControlledCloth};
pub use environment::forces::impulse::{ClothImpulse, Push};
pub use environment::forces::plugin::ForcePlugin;
pub use environment::group_cloths::ClothCollisionPlugin;
pub use environment::layers::{ClothFeatures, ClothLayers};
pub use environment::pressure::ClothPressure;
pub use environment::reactions::{ClothParted, ClothReaction, ClothReactions, ClothTouched};
pub use environment::report_colliders::ScaleInShape;
pub use environment::self_collision::SelfCollision;
pub use environment::sum_reactions::ReactionPlugin;
pub use environment::wind::blast::WindBlast;
pub use environment::wind::fan::WindFan;
pub use environment::wind::field::{GustTravel, WindField};
pub use environment::wind::influence::WindInfluence;
pub use environment::wind::per_particle::{WindPerParticle, WindPerParticlePlugin};
pub use environment::wind::plugin::WindPlugin;
pub use environment::wind::region::{WindRegion, WindShape};
pub use environment::wind::tick_wind::TickWind;
pub use environment::wind::wake::{WakeTrail, WindWake};
pub use fabric::prepare::PreparePlugin;
#[cfg(feature = "gltf")]
pub use gltf::error::{GltfComponentError, GltfComponentFailed};
#[cfg(feature = "gltf")]
pub use gltf::plugin::ClothGltfPlugin;
pub use lod::budget::{ClothBudget, LodCosts};
pub use lod::cost_table::CostTable;
pub use lod::effort::ClothEffort;
pub use lod::lod_set::{LodChoice, LodSet};
pub use lod::report::{ClothCounts, LodReport};
pub use lod::select::LodPlugin;
pub use lod::sleep::{SleepPlugin, WakeCloth};
pub use lod::viewer::{Lens, LodViewer};
pub use motion::anchor_hold::AnchorHold;
pub use motion::attached_vertices::{AttachedVertices, ClothCorner, ClothEdge};
pub use motion::attachment::{Anchor, Attachment, TargetLost};
pub use motion::inertia::ClothInertia;
pub use motion::plugin::AttachmentPlugin;
pub use motion::shift::ShiftOrigin;
pub use motion::teleport::{TeleportCloth, TeleportMode, TeleportPlugin};
pub use parry3d;
#[cfg(feature = "picking")]
pub use picking::drag::{ClothDrag, ClothDragSettings};
#[cfg(feature = "picking")]
pub use picking::pins::{PinBrush, PinStroke};
#[cfg(feature = "picking")]
pub use picking::plugin::ClothDragPlugin;
#[cfg(feature = "render")]
pub use render::cloth_from_mesh::ClothFromMesh;
#[cfg(feature = "render")]
pub use render::debug::{ClothDebugPlugin, ClothGizmos};
#[cfg(feature = "render")]
pub use render::deformer::ClothDeformer;
#[cfg(feature = "render")]
pub use render::image_region::image_region;
#[cfg(feature = "render")]
pub use render::painted_regions::PaintedRegion;
#[cfg(feature = "render")]
pub use render::painted_vertices::PaintedVertices;
#[cfg(feature = "render")]
pub use render::painted_weights::{ColorChannel, PaintedDistance, PaintedWeights, VertexPaint};
#[cfg(feature = "render")]
pub use render::plugin::{ClothRenderPlugin, ClothRenderSystems};
#[cfg(feature = "render")]
pub use render::subdivision::ClothSubdivision;
#[cfg(feature = "weave")]
pub use render::weave::{Weave, WeavePlugin, WovenMaterial};
#[cfg(feature = "serialize")]
pub use save::bytes::SnapshotBytesError;
pub use save::cloth::ClothSnapshot;
pub use save::error::SnapshotError;
pub use save::plugin::SavePlugin;
pub use save::saves::ClothSaves;
pub use save::world::ClothWorldSnapshot;
pub use schedule::{
    ClothSubstep, ClothSubstepSystems, ClothSystems, ClothTick, SchedulePlugin, run_cloth_tick,
};
pub use seams::error::SeamError;
pub use seams::events::{ClothSeamClosed, ClothSeamOpened};
pub use seams::plugin::SeamPlugin;
pub use seams::run::SeamRun;
pub use seams::seam::{ClothSeams, Seam};
pub use settings::ClothSettings;
pub use skeleton::by_vertex::ByVertex;
pub use skeleton::limits::SkinLimits;
pub use skeleton::plugin::SkeletonPlugin;
pub use skeleton::skin::{ClothSkin, SkinError};
pub use spatial::query::{ClothHit, ClothSpatialQuery};
pub use timings::ClothTimings;

/// The items that most apps need.
pub mod prelude {
    pub use crate::{
        Anchor, AnchorHold, AnchorReactions, AttachedVertices, Attachment, ByVertex,
        ClothAcceleration, ClothActivity, ClothAnchorBroke, ClothBudget, ClothCollider,
        ClothCollision, ClothControl, ClothCorner, ClothEdge, ClothError, ClothFailed,
        ClothFeatures, ClothGrab, ClothHit, ClothImpulse, ClothInertia, ClothLayers,
        ClothLevelChanged, ClothMaterial, ClothMesh, ClothParted, ClothPaused, ClothPlugins,
        ClothPreroll, ClothPressure, ClothReactions, ClothRegions, ClothResolution, ClothSaves,
        ClothSeamClosed, ClothSeamOpened, ClothSeams, ClothSeed, ClothSettings, ClothSkin,
        ClothSnapshot, ClothSpatialQuery, ClothState, ClothSurface, ClothSystems, ClothTargetLost,
        ClothTick, ClothTouched, ClothWorldSnapshot, GrabbedVertices, LodSet, LodViewer, Seam,
        SeamError, SeamRun, SelfCollision, ShiftOrigin, SkinError, SkinLimits, SnapshotError,
        TargetLost, TeleportCloth, TeleportMode, WeightsError, WindBlast, WindFan, WindField,
        WindInfluence, WindPerParticle, WindRegion, WindShape, WindWake,
    };
    #[cfg(feature = "render")]
    pub use crate::{
        ClothDeformer, ClothFromMesh, ClothSubdivision, ColorChannel, PaintedDistance,
        PaintedRegion, PaintedVertices, PaintedWeights, VertexPaint, image_region,
    };
    #[cfg(feature = "picking")]
    pub use crate::{ClothDragPlugin, ClothDragSettings, PinBrush, PinStroke};
    #[cfg(feature = "weave")]
    pub use crate::{Weave, WeavePlugin, WovenMaterial};
    pub use bunting_solver::{FabricMaterial, MaterialRegion, MeshPoint, StepLimits, StepSettings};
}

/// All plugins that cloth needs, one for each concern.
///
/// Bevy's `TimePlugin` and `TransformPlugin` must be added, too; `DefaultPlugins` contains both.
///
/// ```
/// use bevy_app::prelude::*;
/// use bevy_bunting::ClothPlugins;
/// use bevy_time::TimePlugin;
/// use bevy_transform::TransformPlugin;
///
/// // A tick in each frame, instead of a fixed step.
/// App::new().add_plugins((TimePlugin, TransformPlugin, ClothPlugins::new(PostUpdate)));
/// ```
#[derive(Debug)]
pub struct ClothPlugins {
    host: Interned<dyn ScheduleLabel>,
}

impl ClothPlugins {
    /// Plugins whose [`ClothTick`] runs in the given schedule. In `PostUpdate` it runs before `TransformSystems::Propagate`;
    /// systems there that move what cloth follows or touches run before [`run_cloth_tick`].
    #[must_use]
    pub fn new(schedule: impl ScheduleLabel) -> Self {
        Self { host: schedule.intern() }
    }
}

impl Default for ClothPlugins {
    /// Plugins whose [`ClothTick`] runs in `FixedPostUpdate`.
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
            .add(SleepPlugin)
            .add(PrerollPlugin)
            .add(LanePlugin)
            .add(WindPlugin)
            .add(WindPerParticlePlugin)
            .add(ForcePlugin)
            .add(AttachmentPlugin)
            .add(AnchorPlugin)
            .add(TeleportPlugin)
            .add(SkeletonPlugin)
            .add(DrivePlugin)
            .add(ColliderPlugin)
            .add(ReactionPlugin)
            .add(PressurePlugin)
            .add(SeamPlugin)
            .add(SelfCollisionPlugin)
            .add(ClothCollisionPlugin)
            .add(SolverPlugin)
            .add(PublishPlugin)
            .add(EasingPlugin)
            .add(LiftPlugin)
            .add(SurfacePlugin)
            .add(SavePlugin)
            .add(ClothDiagnosticsPlugin);
        #[cfg(feature = "render")]
        let group = group.add(ClothRenderPlugin);
        #[cfg(feature = "gltf")]
        let group = group.add(ClothGltfPlugin);
        group
    }
}
