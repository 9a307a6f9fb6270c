//! Viewers: the cameras in whose pictures levels of detail are chosen.

use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bevy_transform::components::Transform;

/// A viewer for which levels of detail are chosen, usually on the camera. Of several viewers, the one in
/// whose picture a cloth is largest counts.
///
/// A viewer looks along −z of its [`Transform`]. With the feature `render`, cameras get a viewer, whose
/// lens and size follow the camera's projection and viewport.
///
/// ```
/// use bevy_bunting::prelude::*;
/// use bevy_transform::prelude::*;
///
/// // A viewer in a server without cameras, who sees 100 m far.
/// let viewer = LodViewer { range: 100.0, ..LodViewer::default() };
/// let viewer = (viewer, Transform::from_xyz(0.0, 2.0, 10.0));
/// # assert_eq!(viewer.0.range, 100.0);
/// ```
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[require(Transform)]
pub struct LodViewer {
    /// The projection of the world onto the picture.
    pub lens: Lens,
    /// Height of the picture, px.
    pub lines: f32,
    /// Width of the picture over its height.
    pub aspect: f32,
    /// Distance beyond which cloth with an automatic choice of levels sleeps, m.
    pub range: f32,
}

impl Default for LodViewer {
    /// A vertical field of view of 60°, 1080 lines of 16:9, and an infinite range.
    fn default() -> Self {
        Self {
            lens: Lens::Perspective { field_of_view: core::f32::consts::FRAC_PI_3 },
            lines: 1080.0,
            aspect: 16.0 / 9.0,
            range: f32::INFINITY,
        }
    }
}

/// The projection of the world onto a picture.
///
/// ```
/// use bevy_bunting::Lens;
/// use bevy_bunting::prelude::*;
///
/// // A server that knows no camera chooses levels for a view of 45°.
/// let lens = Lens::Perspective { field_of_view: core::f32::consts::FRAC_PI_4 };
/// let viewer = LodViewer { lens, ..LodViewer::default() };
/// # assert_eq!(viewer.lens, lens);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Debug, PartialEq, Clone)]
pub enum Lens {
    /// Sizes in the picture are inversely proportional to the distance.
    Perspective {
        /// Vertical field of view, rad.
        field_of_view: f32,
    },
    /// Sizes in the picture do not depend on the distance.
    Orthographic {
        /// Height of the visible part of the world, m.
        height: f32,
    },
}
