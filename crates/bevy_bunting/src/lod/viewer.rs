//! Who looks, and how much of it a cloth fills.

use bevy_ecs::prelude::*;
use bevy_math::{Isometry3d, Vec3};
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bevy_transform::components::{GlobalTransform, Transform};

/// Nothing is looked at from nearer than this, m.
const NEAREST: f32 = 0.1;

/// Levels of detail are chosen for these; put it on the camera. Of several, the one in whose picture
/// a cloth is largest counts.
///
/// It looks along −z of its [`Transform`]. With the feature `render`, cameras have one, which is kept
/// like their projection and their picture.
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[require(Transform)]
pub struct LodViewer {
    /// How the world becomes a picture.
    pub lens: Lens,
    /// Height of the picture, px.
    pub lines: f32,
    /// Width of the picture over its height.
    pub aspect: f32,
    /// Cloth with levels that are chosen automatically is asleep farther away than this, m.
    pub range: f32,
}

impl Default for LodViewer {
    /// A field of view of 60°, 1080 lines of 16:9, no end to its range.
    fn default() -> Self {
        Self {
            lens: Lens::Perspective { field_of_view: core::f32::consts::FRAC_PI_3 },
            lines: 1080.0,
            aspect: 16.0 / 9.0,
            range: f32::INFINITY,
        }
    }
}

/// How the world becomes a picture.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Debug, PartialEq, Clone)]
pub enum Lens {
    /// What is twice as far is half as large.
    Perspective {
        /// Vertical field of view, rad.
        field_of_view: f32,
    },
    /// Everything is as large as it is.
    Orthographic {
        /// Height of what is seen, m.
        height: f32,
    },
}

/// Where a cloth is, seen from all viewers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Sight {
    /// On the screen.
    Seen,
    /// Not far beside it.
    Beside,
    /// Out of every picture.
    #[default]
    OffScreen,
    /// Out of every viewer's range.
    OutOfRange,
}

/// What all viewers together see of a cloth.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Look {
    pub sight: Sight,
    /// Pixels that a metre takes; zero where the cloth is not on or beside a screen.
    pub scale: f32,
}

/// A viewer in its place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View {
    to_view: Isometry3d,
    /// Pixels that a metre takes, at a distance of one metre if there is perspective.
    focal: f32,
    perspective: bool,
    /// Unit normals of the sides of what is seen and of a wider field, outwards: of the right side,
    /// as (across, along), and of the upper one. Without perspective, half extents in metres.
    sides: [[f32; 2]; 2],
    range: f32,
    margin: f32,
}

impl View {
    /// The viewer at a pose. What is beside the screen by less than `margin` rad is not off it.
    pub fn new(viewer: &LodViewer, pose: &GlobalTransform, margin: f32) -> Self {
        let pose = Isometry3d::new(pose.translation(), pose.rotation());
        let (focal, perspective, sides) = match viewer.lens {
            Lens::Perspective { field_of_view } => {
                let slope = bevy_math::ops::tan(0.5 * field_of_view);
                let side = |slope: f32| {
                    let length = (1.0 + slope * slope).sqrt();
                    [1.0 / length, slope / length]
                };
                (0.5 * viewer.lines / slope, true, [side(slope * viewer.aspect), side(slope)])
            }
            Lens::Orthographic { height } => {
                let half = 0.5 * height;
                (viewer.lines / height, false, [[1.0, half * viewer.aspect], [1.0, half]])
            }
        };
        Self { to_view: pose.inverse(), focal, perspective, sides, range: viewer.range, margin }
    }

    /// Distance of a point, m.
    pub fn distance(&self, point: Vec3) -> f32 {
        (self.to_view * point).length()
    }

    /// A ball of a radius around a centre, m.
    pub fn look(&self, centre: Vec3, radius: f32) -> Look {
        let place = self.to_view * centre;
        let distance = (place.length() - radius).max(NEAREST);
        if distance > self.range {
            return Look { sight: Sight::OutOfRange, scale: 0.0 };
        }
        let ahead = -place.z;
        // How far the ball lies out of the picture, m.
        let out = |place: f32, [across, along]: [f32; 2]| {
            let reach = if self.perspective { along * ahead } else { along };
            place.abs() * across - reach - radius
        };
        let behind = -ahead - radius;
        let out = out(place.x, self.sides[0]).max(out(place.y, self.sides[1])).max(behind);
        let beside = self.margin * (distance + radius);
        let sight = if out <= 0.0 {
            Sight::Seen
        } else if out <= beside {
            Sight::Beside
        } else {
            return Look { sight: Sight::OffScreen, scale: 0.0 };
        };
        Look { sight, scale: if self.perspective { self.focal / distance } else { self.focal } }
    }
}

impl Look {
    /// What all viewers see; without any, everything is as near as can be.
    pub fn of(views: &[View], centre: Vec3, radius: f32) -> Self {
        if views.is_empty() {
            return Self { sight: Sight::Seen, scale: f32::MAX.sqrt().sqrt() };
        }
        let looks = views.iter().map(|view| view.look(centre, radius));
        looks
            .reduce(|one, other| Self {
                sight: one.sight.min(other.sight),
                scale: one.scale.max(other.scale),
            })
            .unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn view(viewer: LodViewer) -> View {
        View::new(&viewer, &GlobalTransform::from_xyz(1.0, 0.0, 10.0), 0.1)
    }

    #[test]
    fn pixels_fall_with_the_distance() {
        // 540 lines over a slope of 1/√3 at ten metres.
        let scale = view(LodViewer::default()).look(Vec3::X, 0.0).scale;
        assert!((scale - 54.0 * 3.0_f32.sqrt()).abs() < 1e-3, "{scale}");
        let lens = Lens::Orthographic { height: 10.0 };
        let flat = view(LodViewer { lens, ..LodViewer::default() });
        assert_eq!(flat.look(Vec3::X, 0.0).scale, 108.0);
        assert_eq!(flat.look(Vec3::new(1.0, 0.0, -100.0), 0.0).scale, 108.0);
    }

    #[test]
    fn what_is_beside_the_screen_is_told_from_what_is_off_it() {
        let lenses = [
            Lens::Perspective { field_of_view: core::f32::consts::FRAC_PI_2 },
            Lens::Orthographic { height: 20.0 },
        ];
        for lens in lenses {
            let view = view(LodViewer { lens, aspect: 1.0, range: 50.0, ..LodViewer::default() });
            let sight = |x: f32, y: f32, z: f32| view.look(Vec3::new(x, y, z), 0.5).sight;
            assert_eq!(sight(1.0, 0.0, 0.0), Sight::Seen);
            assert_eq!(sight(11.2, 0.0, 0.0), Sight::Seen, "its edge is");
            assert_eq!(sight(1.0, -10.2, 0.0), Sight::Seen);
            assert_eq!(sight(12.3, 0.0, 0.0), Sight::Beside);
            assert_eq!(sight(1.0, 11.3, 0.0), Sight::Beside);
            assert_eq!(sight(16.0, 0.0, 0.0), Sight::OffScreen);
            assert_eq!(sight(1.0, 0.0, 20.0), Sight::OffScreen, "behind");
            assert_eq!(sight(1.0, 0.0, -60.0), Sight::OutOfRange);
        }
    }

    #[test]
    fn the_largest_picture_counts() {
        let near = LodViewer::default();
        let views =
            [0.0, -30.0].map(|z| View::new(&near, &GlobalTransform::from_xyz(0.0, 0.0, z), 0.1));
        let look = |z: f32| Look::of(&views, Vec3::new(0.0, 0.0, z), 0.5);
        assert_eq!(look(-32.0).scale, views[1].look(Vec3::new(0.0, 0.0, -32.0), 0.5).scale);
        // Behind one, before the other.
        assert_eq!(look(-20.0), views[0].look(Vec3::new(0.0, 0.0, -20.0), 0.5));
        assert_eq!(look(20.0).sight, Sight::OffScreen);
        assert_eq!(Look::of(&[], Vec3::ZERO, 0.5).sight, Sight::Seen);
    }
}
