//! The plugin that leads cloths by skeletons.

use bevy_app::prelude::*;
use bevy_app::{AnimationSystems, RunFixedMainLoop};
use bevy_ecs::prelude::*;
use bevy_transform::TransformSystems;
use bevy_transform::systems::mark_dirty_trees;

use crate::anchors::hold::hold_cloths;
use crate::batch::publish::{publish_states, reset_diverged};
use crate::fabric::prepare::change_materials;
use crate::motion::lead::lead_pins;
use crate::motion::observation_times::begin_frame;
use crate::motion::observe::{observe_frames, observe_ticks};
use crate::motion::place::place_cloths;
#[cfg(feature = "render")]
use crate::render::plugin::ClothRenderSystems;
use crate::schedule::{ClothSystems, ClothTick, run_cloth_tick};
use crate::skeleton::by_vertex::ByVertex;
use crate::skeleton::check::{bare, check_skins, free, release};
use crate::skeleton::joints::{observe_joints_in_frames, observe_joints_in_ticks};
use crate::skeleton::lead::{blend_skins, lead_skins};
use crate::skeleton::limits::SkinLimits;
use crate::skeleton::show::show_poses;
use crate::skeleton::skin::ClothSkin;

/// Leads cloths by the skeletons that their [`ClothSkin`]s name.
#[derive(Debug, Default)]
pub struct SkeletonPlugin;

impl Plugin for SkeletonPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<ClothSkin>()
            .register_type::<SkinLimits>()
            .register_type::<ByVertex>()
            .add_observer(bare)
            .add_observer(release)
            .add_observer(free)
            .add_systems(
                RunFixedMainLoop,
                observe_joints_in_frames::<true>.after(begin_frame).before(observe_frames::<true>),
            )
            .add_systems(
                ClothTick,
                (
                    (check_skins, observe_joints_in_ticks)
                        .chain()
                        .in_set(ClothSystems::Prepare)
                        .after(change_materials)
                        .before(observe_ticks),
                    lead_skins.in_set(ClothSystems::Drive).after(lead_pins).before(hold_cloths),
                    blend_skins
                        .in_set(ClothSystems::Publish)
                        .after(publish_states)
                        .before(reset_diverged),
                ),
            );
        let observe = observe_joints_in_frames::<false>.before(observe_frames::<false>);
        let show = (observe, show_poses.after(place_cloths))
            .chain()
            .after(AnimationSystems)
            .after(run_cloth_tick)
            .in_set(TransformSystems::Propagate)
            .before(mark_dirty_trees);
        #[cfg(feature = "render")]
        let show = show.before(ClothRenderSystems::UpdateMeshes);
        app.add_systems(PostUpdate, show);
    }
}
