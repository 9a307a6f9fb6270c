//! The position and size of a cloth in the pictures of all viewers.

use bevy_math::{Isometry3d, Vec3};
use bevy_transform::components::GlobalTransform;

use crate::lod::viewer::{Lens, LodViewer};

/// Least distance of a cloth from a viewer, m: nearer cloths count as being at this distance, so that sizes
/// stay finite.
const LEAST_DISTANCE: f32 = 0.1;

/// Visibility of a cloth; of several viewers' values the least one counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Sight {
    /// On the screen.
    OnScreen,
    /// Beside the screen, within the margin.
    NearScreen,
    /// Outside of every picture and its margin.
    #[default]
    OffScreen,
    /// Out of every viewer's range.
    OutOfRange,
}

/// The cloth as seen by all viewers together.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Sighting {
    pub sight: Sight,
    /// Pixels for each metre at the cloth, px/m; 0 if the cloth is neither on nor near a screen.
    pub pixels_per_metre: f32,
}

/// A viewer at a pose.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View {
    to_view: Isometry3d,
    /// Pixels for each metre, px/m; with perspective, at a distance of one metre.
    focal: f32,
    has_perspective: bool,
    /// The right and the upper side of the picture. With perspective, the side's outward unit normal as
    /// [across, along the line of sight]; without, 1 and half the picture's extent in m.
    sides: [[f32; 2]; 2],
    range: f32,
    margin: f32,
}

impl View {
    /// A viewer at a pose. Cloth beside the screen by less than `margin` rad is near the screen.
    pub fn new(viewer: &LodViewer, pose: &GlobalTransform, margin: f32) -> Self {
        let pose = Isometry3d::new(pose.translation(), pose.rotation());
        let (focal, has_perspective, sides) = match viewer.lens {
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
        Self { to_view: pose.inverse(), focal, has_perspective, sides, range: viewer.range, margin }
    }

    /// Distance of a point (m) from the viewer, m.
    pub fn distance(&self, point: Vec3) -> f32 {
        (self.to_view * point).length()
    }

    /// The view of a ball with a centre and a radius, m.
    pub fn sighting(&self, centre: Vec3, radius: f32) -> Sighting {
        let place = self.to_view * centre;
        let distance = (place.length() - radius).max(LEAST_DISTANCE);
        if distance > self.range {
            return Sighting { sight: Sight::OutOfRange, pixels_per_metre: 0.0 };
        }
        let ahead = -place.z;
        // Distance of the ball from one side of the picture, m; negative inside.
        let outside = |place: f32, [across, along]: [f32; 2]| {
            let reach = if self.has_perspective { along * ahead } else { along };
            place.abs() * across - reach - radius
        };
        let behind = -ahead - radius;
        let outside =
            outside(place.x, self.sides[0]).max(outside(place.y, self.sides[1])).max(behind);
        let margin = self.margin * (distance + radius);
        let sight = if outside <= 0.0 {
            Sight::OnScreen
        } else if outside <= margin {
            Sight::NearScreen
        } else {
            return Sighting { sight: Sight::OffScreen, pixels_per_metre: 0.0 };
        };
        let pixels_per_metre =
            if self.has_perspective { self.focal / distance } else { self.focal };
        Sighting { sight, pixels_per_metre }
    }
}

impl Sighting {
    /// The view of a ball with a centre and a radius, m, by all viewers together. Without a viewer the ball
    /// is on the screen, and larger than any screen.
    pub fn of(views: &[View], centre: Vec3, radius: f32) -> Self {
        if views.is_empty() {
            // The fourth power of this size is still finite: see `importance` in `select.rs`.
            let pixels_per_metre = f32::MAX.sqrt().sqrt();
            return Self { sight: Sight::OnScreen, pixels_per_metre };
        }
        let sightings = views.iter().map(|view| view.sighting(centre, radius));
        sightings
            .reduce(|one, other| Self {
                sight: one.sight.min(other.sight),
                pixels_per_metre: one.pixels_per_metre.max(other.pixels_per_metre),
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
        let scale = view(LodViewer::default()).sighting(Vec3::X, 0.0).pixels_per_metre;
        assert!((scale - 54.0 * 3.0_f32.sqrt()).abs() < 1e-3, "{scale}");
        let lens = Lens::Orthographic { height: 10.0 };
        let flat = view(LodViewer { lens, ..LodViewer::default() });
        assert_eq!(flat.sighting(Vec3::X, 0.0).pixels_per_metre, 108.0);
        assert_eq!(flat.sighting(Vec3::new(1.0, 0.0, -100.0), 0.0).pixels_per_metre, 108.0);
    }

    #[test]
    fn what_is_beside_the_screen_is_told_from_what_is_off_it() {
        let lenses = [
            Lens::Perspective { field_of_view: core::f32::consts::FRAC_PI_2 },
            Lens::Orthographic { height: 20.0 },
        ];
        for lens in lenses {
            let view = view(LodViewer { lens, aspect: 1.0, range: 50.0, ..LodViewer::default() });
            let sight = |x: f32, y: f32, z: f32| view.sighting(Vec3::new(x, y, z), 0.5).sight;
            assert_eq!(sight(1.0, 0.0, 0.0), Sight::OnScreen);
            assert_eq!(sight(11.2, 0.0, 0.0), Sight::OnScreen, "its edge is");
            assert_eq!(sight(1.0, -10.2, 0.0), Sight::OnScreen);
            assert_eq!(sight(12.3, 0.0, 0.0), Sight::NearScreen);
            assert_eq!(sight(1.0, 11.3, 0.0), Sight::NearScreen);
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
        let sighting = |z: f32| Sighting::of(&views, Vec3::new(0.0, 0.0, z), 0.5);
        assert_eq!(
            sighting(-32.0).pixels_per_metre,
            views[1].sighting(Vec3::new(0.0, 0.0, -32.0), 0.5).pixels_per_metre
        );
        // The ball is behind one viewer and in front of the other.
        assert_eq!(sighting(-20.0), views[0].sighting(Vec3::new(0.0, 0.0, -20.0), 0.5));
        assert_eq!(sighting(20.0).sight, Sight::OffScreen);
        assert_eq!(Sighting::of(&[], Vec3::ZERO, 0.5).sight, Sight::OnScreen);
    }
}
