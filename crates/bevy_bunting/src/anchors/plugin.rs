//! The plugin of what holds cloths, and of what they do to it.

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;

use crate::anchors::breaking::break_anchors;
use crate::anchors::follow::{follow_grabs, follow_holds, let_go};
use crate::anchors::grab::{ClothGrab, GrabbedVertices};
use crate::anchors::hold::hold_cloths;
use crate::anchors::reactions::AnchorReactions;
use crate::anchors::report::{ask_for_reactions, publish_reactions, stop_reporting};
use crate::batch::publish::reset_diverged;
use crate::display::ease::ease_surfaces;
use crate::environment::drive::drive_cloths;
use crate::fabric::prepare::change_materials;
use crate::lod::sleep::send_to_sleep;
use crate::motion::anchor_hold::AnchorHold;
use crate::motion::lead::lead_pins;
use crate::motion::lost_target::handle_lost_targets;
use crate::motion::observe::observe_ticks;
use crate::schedule::{ClothSystems, ClothTick};

/// Holds cloths by springs and rails, and reports what cloths do to that which holds them.
#[derive(Debug, Default)]
pub struct AnchorPlugin;

impl Plugin for AnchorPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<AnchorReactions>()
            .register_type::<AnchorHold>()
            .register_type::<ClothGrab>()
            .register_type::<GrabbedVertices>()
            .add_observer(stop_reporting)
            .add_observer(let_go)
            .add_systems(
                ClothTick,
                (
                    break_anchors.in_set(ClothSystems::Prepare).before(handle_lost_targets),
                    (follow_holds, follow_grabs)
                        .chain()
                        .in_set(ClothSystems::Prepare)
                        .after(change_materials)
                        .before(observe_ticks),
                    (hold_cloths, ask_for_reactions)
                        .chain()
                        .in_set(ClothSystems::Drive)
                        .after(lead_pins)
                        .before(drive_cloths),
                    publish_reactions
                        .in_set(ClothSystems::Publish)
                        .after(reset_diverged)
                        .before(ease_surfaces)
                        .before(send_to_sleep),
                ),
            );
    }
}
