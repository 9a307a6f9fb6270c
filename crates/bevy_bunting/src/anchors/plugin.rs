//! The plugin of what cloths do to that which holds them.

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;

use crate::anchors::reactions::AnchorReactions;
use crate::anchors::report::{ask_for_reactions, publish_reactions, stop_reporting};
use crate::batch::publish::reset_diverged;
use crate::environment::drive::drive_cloths;
use crate::lod::sleep::send_to_sleep;
use crate::motion::lead::lead_pins;
use crate::schedule::{ClothSystems, ClothTick};

/// Reports what cloths do to that which holds them.
#[derive(Debug, Default)]
pub struct AnchorPlugin;

impl Plugin for AnchorPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<AnchorReactions>().add_observer(stop_reporting).add_systems(
            ClothTick,
            (
                ask_for_reactions.in_set(ClothSystems::Drive).after(lead_pins).before(drive_cloths),
                publish_reactions
                    .in_set(ClothSystems::Publish)
                    .after(reset_diverged)
                    .before(send_to_sleep),
            ),
        );
    }
}
