//! The plugin that observes the poses of attachments' targets and places cloths on them.

use bevy_app::prelude::*;
use bevy_app::{AnimationSystems, RunFixedMainLoop, RunFixedMainLoopSystems};
use bevy_ecs::prelude::*;
use bevy_transform::TransformSystems;
use bevy_transform::systems::{
    mark_dirty_trees, propagate_parent_transforms, sync_simple_transforms,
};
use bunting_solver::MeshPoint;

use crate::batch::publish::reset_diverged;
use crate::environment::drive::drive_cloths;
use crate::fabric::prepare::{change_materials, cut_cloths};
use crate::motion::anchor_poses::{
    observe_anchors_at_end_of_ticks, observe_anchors_in_frames, observe_anchors_in_ticks,
};
use crate::motion::attached_vertices::{AttachedVertices, ClothCorner, ClothEdge};
use crate::motion::attachment::{Anchor, Attachment, TargetLost};
use crate::motion::bring::bring_vertices;
use crate::motion::follow::{follow_targets, stop_following};
use crate::motion::follow_anchors::follow_anchors;
use crate::motion::grow::grow_cloths;
use crate::motion::inertia::ClothInertia;
use crate::motion::lead::lead_pins;
use crate::motion::lost_target::handle_lost_targets;
use crate::motion::observation_times::{ObservationTimes, begin_frame};
use crate::motion::observe::{
    observe_enabled, observe_end_of_ticks, observe_frames, observe_ticks,
};
use crate::motion::place::place_cloths;
use crate::motion::report_idle::report_idle_attachments;
use crate::motion::report_inertia::report_inertia;
use crate::motion::scale::remove_scales;
use crate::motion::shift::shift_poses;
use crate::schedule::{ClothSystems, ClothTick, run_cloth_tick};

/// Observes the targets of attachments, and places cloths on them.
#[derive(Debug, Default)]
pub struct AttachmentPlugin;

impl Plugin for AttachmentPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<Attachment>()
            .register_type::<Anchor>()
            .register_type::<AttachedVertices>()
            .register_type::<MeshPoint>()
            .register_type::<ClothEdge>()
            .register_type::<ClothCorner>()
            .register_type::<TargetLost>()
            .register_type::<ClothInertia>()
            .init_resource::<ObservationTimes>()
            .add_observer(stop_following)
            .add_observer(shift_poses)
            .add_observer(observe_enabled)
            .add_systems(
                RunFixedMainLoop,
                (
                    (begin_frame, observe_anchors_in_frames::<true>, observe_frames::<true>)
                        .chain()
                        .after(RunFixedMainLoopSystems::BeforeFixedMainLoop)
                        .before(RunFixedMainLoopSystems::FixedMainLoop),
                    (observe_anchors_at_end_of_ticks, observe_end_of_ticks)
                        .chain()
                        .after(RunFixedMainLoopSystems::FixedMainLoop)
                        .before(RunFixedMainLoopSystems::AfterFixedMainLoop)
                        .run_if(|times: Res<ObservationTimes>| times.has_ticked()),
                ),
            )
            .add_systems(
                ClothTick,
                (
                    (
                        (follow_targets, follow_anchors, report_idle_attachments)
                            .chain()
                            .after(change_materials),
                        observe_anchors_in_ticks,
                        observe_ticks,
                        grow_cloths,
                    )
                        .chain()
                        .in_set(ClothSystems::Prepare),
                    bring_vertices
                        .in_set(ClothSystems::Prepare)
                        .after(handle_lost_targets)
                        .before(cut_cloths),
                    report_inertia.in_set(ClothSystems::Prepare),
                    lead_pins.in_set(ClothSystems::Drive).before(drive_cloths),
                    place_cloths.in_set(ClothSystems::Publish).before(reset_diverged),
                ),
            )
            // The first part of the propagation, so that it sees whatever a system that runs before the propagation moves.
            .add_systems(
                PostUpdate,
                (
                    follow_targets,
                    observe_anchors_in_frames::<false>,
                    observe_frames::<false>,
                    place_cloths,
                )
                    .chain_ignore_deferred()
                    .after(AnimationSystems)
                    .after(run_cloth_tick)
                    .in_set(TransformSystems::Propagate)
                    .before(mark_dirty_trees),
            )
            .add_systems(
                PostUpdate,
                remove_scales
                    .in_set(TransformSystems::Propagate)
                    .after(propagate_parent_transforms)
                    .after(sync_simple_transforms),
            );
    }
}
