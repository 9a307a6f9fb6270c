//! What is saved of a cloth.

use std::sync::Arc;

use bevy_math::{Affine3A, Vec3};
use bunting_solver::FabricMaterial;

use crate::anchors::reactions::AnchorReaction;
use crate::cloth::activity::ClothActivity;
use crate::cloth::imperfection::ClothSeed;
use crate::cloth::restored::Pending;
use crate::fabric::levels::ClothLevels;
use crate::lod::effort::ClothEffort;
use crate::lod::record::SavedRecord;
use crate::motion::growth::Growth;
use crate::motion::inertia::ClothInertia;
use crate::motion::observation_times::ObservationTimes;
use crate::motion::pose::PoseHistory;
use crate::motion::take_up::TakingUp;
use crate::save::surface::SavedSurface;
use crate::seams::sewn::SeamProgress;
use crate::skeleton::joints::SavedJoint;

/// The state of a cloth between two ticks: all that a tick reads and that is not in components of the user's. Restored to a
/// cloth of the same components, in the same app or in another, that cloth goes on with the same bits.
///
/// It is taken and restored by [`ClothSaves`](crate::ClothSaves). With the feature `serialize` it is written
/// as bytes (`to_bytes`), which hold a version and a checksum, and implements serde's traits by these bytes.
///
/// Clones share their content.
///
/// ```
/// use std::time::Duration;
///
/// use bevy_app::prelude::*;
/// use bevy_bunting::prelude::*;
/// use bevy_time::{TimePlugin, TimeUpdateStrategy};
/// use bevy_transform::prelude::*;
///
/// let mut app = App::new();
/// app.add_plugins((TimePlugin, TransformPlugin, ClothPlugins::default()))
///     .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f32(1.0 / 60.0)));
/// let flag = (ClothMesh::grid(17, 17, 1.0, 1.0), Attachment::in_place(ClothEdge::Left));
/// let flag = app.world_mut().spawn(flag).id();
/// (0..10).for_each(|_| app.update());
///
/// let snapshot = app.world().save_cloth(flag)?;
/// (0..10).for_each(|_| app.update());
/// app.world_mut().restore_cloth(flag, &snapshot)?;
/// # Ok::<(), SnapshotError>(())
/// ```
#[derive(Clone, Debug)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "Vec<u8>", into = "Vec<u8>")
)]
pub struct ClothSnapshot(pub(super) Arc<SavedCloth>);

impl ClothSnapshot {
    /// The level of detail of the cloth; 0 is the finest.
    #[must_use]
    pub fn level(&self) -> usize {
        self.0.level
    }

    /// Positions of the cloth's particles at its level, m, in its frame.
    #[must_use]
    pub fn positions(&self) -> &[Vec3] {
        &self.0.state.positions
    }
}

/// The state of a cloth.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct SavedCloth {
    /// The last observation of poses before the cloth was saved, to whose clock all times belong.
    pub times: ObservationTimes,
    /// The levels, which stay as long as snapshots that were not written as bytes.
    #[cfg_attr(feature = "serialize", serde(skip))]
    pub levels: Option<Arc<ClothLevels>>,
    pub level_count: usize,
    pub fingerprint: u32,
    pub level: usize,
    pub state: bunting_solver::ClothSnapshot,
    /// Length of the last tick, s.
    pub tick: f32,
    /// Whether the cloth had a lane.
    pub in_lane: bool,
    pub seed: ClothSeed,
    pub unmoved: bool,
    pub activity: ClothActivity,
    pub material: FabricMaterial,
    /// m/s².
    pub gravity: Vec3,
    pub inertia: Option<ClothInertia>,
    pub target_lost: bool,
    pub frozen: bool,
    pub taking_up: Option<TakingUp>,
    pub is_posed: bool,
    pub pending: Pending,
    /// Whether colliders were near the cloth in its last tick.
    pub touches: bool,
    pub effort: ClothEffort,
    pub record: Option<SavedRecord>,
    /// Number of ticks for which the cloth has been at rest.
    pub rest_ticks: u32,
    pub rest_places: Vec<Vec3>,
    pub rest_pose: Option<bevy_math::Isometry3d>,
    pub rest_rounding: f32,
    pub growth: Growth,
    pub frame: PoseHistory,
    /// One for each anchor.
    pub anchors: Vec<PoseHistory>,
    pub skin: Option<SavedSkin>,
    /// One for each seam.
    pub seams: Vec<SeamProgress>,
    pub reactions: Option<SavedReactions>,
    pub surface: SavedSurface,
}

/// The state of a cloth's skeleton.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct SavedSkin {
    pub joints: Vec<SavedJoint>,
    /// Skinning matrices of the particles' places; none before the first tick.
    pub matrices: Option<Vec<Affine3A>>,
}

/// What a cloth did to that which holds it.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct SavedReactions {
    pub target: AnchorReaction,
    pub anchors: Vec<AnchorReaction>,
    /// Velocities of the pins at the end of the last tick, m/s.
    pub pin_velocities: Vec<Vec3>,
}
