//! A scarf that is held at the neck and hangs down the back.

use bevy::prelude::*;
use bevy_bunting::prelude::*;
use bunting_scenes::Design;

use crate::figure::skeleton::Joint;
use crate::scenes::wardrobe::patterns::WOOL;

/// Width and length, m.
const SIZE: Vec2 = Vec2::new(0.14, 0.75);

/// The middle of the upper edge in the figure's frame at rest, m.
const NAPE: Vec3 = Vec3::new(0.0, 1.475, 0.125);

/// Colours of the stripes.
const STRIPES: [[u8; 3]; 2] = [[190, 60, 40], [222, 168, 60]];

/// Spawns the scarf on the joints of a figure.
pub fn spawn(commands: &mut Commands, joints: &[Entity]) -> Entity {
    let chest = joints[Joint::Chest.index()];
    let corner = NAPE - 0.5 * SIZE.x * Vec3::X - Joint::Chest.place();
    let cloth = commands.spawn((
        ClothMesh::grid(5, 17, SIZE.x, SIZE.y),
        ClothMaterial(WOOL),
        Attachment::new(chest, ClothEdge::Top).with_offset(Transform::from_translation(corner)),
        Design::Bars(STRIPES.repeat(5)),
    ));
    cloth.id()
}
