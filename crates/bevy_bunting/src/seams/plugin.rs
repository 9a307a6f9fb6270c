//! The plugin of seams.

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;

use crate::environment::drive_pressures::drive_pressures;
use crate::environment::drive_self_collisions::drive_self_collisions;
use crate::schedule::{ClothSystems, ClothTick};
use crate::seams::seam::ClothSeams;
use crate::seams::sew::sew_cloths;

/// Sews each cloth with [`ClothSeams`] together.
#[derive(Debug, Default)]
pub struct SeamPlugin;

impl Plugin for SeamPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<ClothSeams>().add_systems(
            ClothTick,
            sew_cloths
                .in_set(ClothSystems::Drive)
                .after(drive_pressures)
                .before(drive_self_collisions),
        );
    }
}
