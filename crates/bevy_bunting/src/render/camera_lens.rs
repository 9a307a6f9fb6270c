//! Cameras look at levels of detail through their own lens.

use bevy_camera::{Camera, Projection};
use bevy_ecs::prelude::*;

use crate::lod::{Lens, LodViewer};

/// Keeps the viewers on cameras like the cameras' projection and picture. A projection of the user's
/// own leaves the lens alone.
pub fn view_through_cameras(mut viewers: Query<(&Camera, &Projection, &mut LodViewer)>) {
    for (camera, projection, mut viewer) in &mut viewers {
        let mut seen = *viewer;
        match projection {
            Projection::Perspective(perspective) => {
                seen.lens = Lens::Perspective { field_of_view: perspective.fov };
            }
            Projection::Orthographic(orthographic) => {
                seen.lens = Lens::Orthographic { height: orthographic.area.height() };
            }
            Projection::Custom(_) => {}
        }
        if let Some(size) = camera.physical_viewport_size().filter(|size| size.min_element() > 0) {
            seen.lines = size.y as f32;
            seen.aspect = size.x as f32 / size.y as f32;
        }
        viewer.set_if_neq(seen);
    }
}
