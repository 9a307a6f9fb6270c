//! The field: two hundred flags on masts, on both sides of a road.

use bevy::prelude::*;
use bevy_bunting::prelude::*;
use bunting_scenes::Design;

use crate::scenes::storm::weather::WIND;

/// Masts along the wind and across it.
const MASTS: (u16, u16) = (20, 10);

/// Distance of two masts along the wind and across it, m.
const SPACING: (f32, f32) = (4.0, 3.5);

/// Width of the road between the two halves of the field, m.
const ROAD: f32 = 2.5;

/// Size of a flag, m.
const FLAG: (f32, f32) = (1.2, 0.8);

/// Colours of the flags, one for each row across the wind.
const COLOURS: [[u8; 3]; 5] =
    [[225, 95, 45], [235, 180, 60], [20, 105, 110], [85, 45, 100], [200, 60, 60]];

/// A mast; +y is up, and its flag flies along +x.
#[derive(Component, Clone, Copy, Debug)]
pub struct Mast;

impl Mast {
    /// Height, m.
    pub const HEIGHT: f32 = 2.4;

    /// Radius, m.
    pub const RADIUS: f32 = 0.025;
}

/// Feet of the masts, m.
pub fn places() -> impl Iterator<Item = Vec3> {
    let at = |index: u16, count: u16, spacing: f32| {
        (f32::from(index) - 0.5 * f32::from(count - 1)) * spacing
    };
    (0..MASTS.0).flat_map(move |column| {
        (0..MASTS.1).map(move |row| {
            let across = at(row, MASTS.1, SPACING.1);
            Vec3::new(at(column, MASTS.0, SPACING.0), 0.0, across + across.signum() * 0.5 * ROAD)
        })
    })
}

/// Spawns the flags.
pub fn spawn(commands: &mut Commands) {
    let downwind = Vec3::new(WIND.velocity.x, 0.0, WIND.velocity.z);
    for (index, foot) in places().enumerate() {
        let stand = Transform::from_translation(foot).looking_to(Vec3::Y.cross(downwind), Vec3::Y);
        let mast = commands.spawn((Mast, stand)).id();
        let colour = COLOURS[index % usize::from(MASTS.1) % COLOURS.len()];
        commands.spawn((
            ClothMesh::grid(17, 13, FLAG.0, FLAG.1),
            ClothMaterial::FLAG_POLYESTER,
            LodSet::new([40.0, 60.0]),
            Attachment::new(mast, ClothEdge::Left).with_offset(Transform::from_xyz(
                Mast::RADIUS,
                Mast::HEIGHT,
                0.0,
            )),
            Design::Bars(vec![colour, [245, 240, 225], colour]),
        ));
    }
}
