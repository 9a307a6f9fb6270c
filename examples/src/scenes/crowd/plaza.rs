//! The plaza: flags and banners on masts, a viewer and wind.

use std::f32::consts::TAU;

use bevy::prelude::*;
use bevy_bunting::prelude::*;

use crate::scenes::crowd::flight;

/// Spacing of the masts on a sunflower's spiral, m: the k-th mast stands at this times √k from the centre,
/// one on 10 m².
const SPACING: f32 = 1.8;

/// Turn from one mast to the next, as a fraction of a full turn: the golden angle.
const GOLDEN: f32 = 0.381_966;

/// One cloth in this many is a banner.
const BANNER_PERIOD: usize = 5;

/// Levels of detail of each cloth.
pub const LEVELS: usize = 4;

/// Height of the lowest mast, and difference between the highest and the lowest, m.
const HEIGHTS: (f32, f32) = (3.2, 1.6);

/// A mast with its height in m; +y is up, and its cloth flies along +x.
#[derive(Component, Clone, Copy, Debug)]
pub struct Mast(pub f32);

impl Mast {
    /// Radius, m.
    pub const RADIUS: f32 = 0.025;

    /// Distance from the top of the mast to its cloth, m.
    const FREE_TOP: f32 = 0.05;

    /// Pose of the cloth's attachment in the frame of the mast.
    fn hoist(self) -> Transform {
        Transform::from_xyz(Self::RADIUS, self.0 - Self::FREE_TOP, 0.0)
    }
}

/// Spawns a viewer, wind, and the given number of cloths.
pub fn spawn(commands: &mut Commands, cloths: usize) {
    let wind = WindField::steady(Vec3::new(5.0, 0.0, 2.0)).with_gusts(1.5, 0.4, 3);
    commands.spawn(wind);
    commands.spawn((LodViewer::default(), flight::pose(0.0)));
    for index in 0..cloths {
        spawn_cloth(commands, index, wind.velocity);
    }
}

fn spawn_cloth(commands: &mut Commands, index: usize, wind: Vec3) {
    let (angle, radius) = (TAU * GOLDEN * index as f32, SPACING * (index as f32).sqrt());
    let foot = Vec3::new(radius * angle.cos(), 0.0, radius * angle.sin());
    // Fractional parts of multiples of an irrational number are evenly spread and never repeat.
    let mast = Mast(HEIGHTS.0 + HEIGHTS.1 * (0.754_878 * index as f32).fract());
    let stand = Transform::from_translation(foot).looking_to(Vec3::Y.cross(wind), Vec3::Y);
    let target = commands.spawn((mast, stand)).id();
    let (mesh, edge) = if index.is_multiple_of(BANNER_PERIOD) {
        (ClothMesh::grid(17, 33, 0.7, 1.4), ClothEdge::Top)
    } else {
        (ClothMesh::grid(33, 33, 1.2, 0.8), ClothEdge::Left)
    };
    commands.spawn((
        mesh,
        ClothMaterial::FLAG_POLYESTER,
        LodSet::automatic(LEVELS),
        Attachment::new(target, edge).with_offset(mast.hoist()),
    ));
}
