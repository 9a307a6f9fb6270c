//! Viewers on cameras: their lens and size follow the camera's projection and viewport.

use bevy_camera::{Camera, Camera3d, Projection};
use bevy_ecs::prelude::*;

use crate::lod::viewer::{Lens, LodViewer};

/// Puts a viewer on each new `Camera3d`.
pub fn add_viewer(added: On<Add, Camera3d>, mut commands: Commands) {
    commands.entity(added.entity).try_insert_if_new(LodViewer::default());
}

/// Sets the lens and the size of viewers on cameras. A custom projection leaves the lens as it is.
pub fn follow_cameras(mut viewers: Query<(&Camera, &Projection, &mut LodViewer)>) {
    for (camera, projection, mut viewer) in &mut viewers {
        let mut new = *viewer;
        match projection {
            Projection::Perspective(perspective) => {
                new.lens = Lens::Perspective { field_of_view: perspective.fov };
            }
            Projection::Orthographic(orthographic) => {
                new.lens = Lens::Orthographic { height: orthographic.area.height() };
            }
            Projection::Custom(_) => {}
        }
        if let Some(size) = camera.physical_viewport_size().filter(|size| size.min_element() > 0) {
            new.lines = size.y as f32;
            new.aspect = size.x as f32 / size.y as f32;
        }
        viewer.set_if_neq(new);
    }
}
