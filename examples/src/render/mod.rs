//! Windows and pictures of examples.

#[cfg(feature = "inspector")]
mod inspector;
pub mod keys;
pub mod orbit;
pub mod picture_options;
pub mod pictures;
pub mod print;
mod sky;
pub mod stage;
pub mod title;
pub mod wind;
pub mod window;

use bevy::prelude::*;
use bevy_bunting::prelude::*;

use crate::View;

/// The one viewer of an example.
///
/// # Panics
///
/// If there is not exactly one [`LodViewer`].
pub fn viewer(app: &mut App) -> Entity {
    let world = app.world_mut();
    world.flush();
    let mut viewers = world.query_filtered::<Entity, With<LodViewer>>();
    viewers.single(world).expect("an example has one viewer")
}

/// Lets the mouse move the viewer around the centre of a view, and keys change the wind and show
/// gizmos.
pub fn control_orbit(app: &mut App, view: View) {
    let viewer = viewer(app);
    app.world_mut().entity_mut(viewer).insert(orbit::Orbit::new(view));
    app.add_plugins((orbit::plugin, wind::plugin, keys::gizmos));
}
