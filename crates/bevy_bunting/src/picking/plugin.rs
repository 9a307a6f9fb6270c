//! The plugin that lets pointers drag cloths.

use bevy_app::{App, Plugin, PreUpdate};
use bevy_ecs::prelude::*;
use bevy_picking::backend::ray::RayMap;
use bevy_picking::{PickingPlugin, PickingSystems};

use crate::picking::backend::find_cloths;
use crate::picking::drag::{ClothDrag, ClothDragSettings, drag, grab};
use crate::picking::pins::{self, PinBrush};

/// Lets pointers (mouse, touch, or the user's own) drag cloths: the vertices under the pointer are grabbed when its primary
/// button is pressed, follow it in a plane parallel to the picture, and are let go with the button.
///
/// It needs Bevy's picking, which `DefaultPlugins` have with the feature `bevy_picking`, elsewhere
/// `DefaultPickingPlugins`; and it is its backend for cloths, so that all events of `Pointer` are sent for them, too.
/// A cloth with `Pickable::IGNORE` is neither. Other entities in front of a cloth shield it if a backend reports
/// them, such as Bevy's `MeshPickingPlugin`. Rigid triangles are not picked. [`ClothDragSettings`] has reach and
/// strength; with a [`PinBrush`] that is not off, pointers paint pins instead.
///
/// ```
/// use bevy_app::prelude::*;
/// use bevy_bunting::prelude::*;
/// use bevy_picking::{InteractionPlugin, PickingPlugin};
///
/// // In a window, instead: App::new().add_plugins((DefaultPlugins, ClothPlugins::default(), ClothDragPlugin));
/// App::new().add_plugins((PickingPlugin, InteractionPlugin, ClothDragPlugin));
/// ```
#[derive(Debug, Default)]
pub struct ClothDragPlugin;

impl Plugin for ClothDragPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<ClothDragSettings>()
            .register_type::<ClothDragSettings>()
            .register_type::<ClothDrag>()
            .init_resource::<PinBrush>()
            .register_type::<PinBrush>()
            .add_observer(grab)
            .add_observer(pins::begin)
            .add_observer(pins::go_on)
            .add_systems(
                PreUpdate,
                (find_cloths.in_set(PickingSystems::Backend), drag.in_set(PickingSystems::Last))
                    .run_if(resource_exists::<RayMap>),
            );
    }

    fn finish(&self, app: &mut App) {
        if !app.is_plugin_added::<PickingPlugin>() {
            log::error!("ClothDragPlugin needs Bevy's PickingPlugin: no cloth is dragged");
        }
    }
}
