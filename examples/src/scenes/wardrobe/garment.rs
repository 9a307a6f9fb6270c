//! The pieces of clothing, and how they are put on and taken off.

use bevy::prelude::*;
use bevy_bunting::prelude::*;

use crate::figure::cloak;
use crate::scenes::wardrobe::layers::{ARMS, BARE, BODY, CLOTHES, ROOM, SKIRTED};
use crate::scenes::wardrobe::patterns::{JACKET, SHIRT, SKIRT};
use crate::scenes::wardrobe::scarf;

/// A piece of clothing.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
pub enum Garment {
    Skirt,
    Shirt,
    Jacket,
    Scarf,
    Cape,
}

/// Particles along each edge of the cape.
const CAPE: u32 = 21;

/// Distance of clothes from one another, m.
const THICKNESS: f32 = 0.006;

impl Garment {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Skirt, Self::Shirt, Self::Jacket, Self::Scarf, Self::Cape];

    /// Spawns it on the joints of a figure.
    pub fn put_on(self, commands: &mut Commands, joints: &[Entity]) {
        let cloth = match self {
            Self::Skirt => SKIRT.sew(commands, joints),
            Self::Shirt => SHIRT.sew(commands, joints),
            Self::Jacket => JACKET.sew(commands, joints),
            Self::Scarf => scarf::spawn(commands, joints),
            Self::Cape => cloak::spawn(commands, joints, CAPE),
        };
        let touched = match self {
            Self::Skirt => BARE,
            Self::Shirt | Self::Jacket => SKIRTED,
            Self::Scarf | Self::Cape => SKIRTED | ARMS,
        };
        commands.entity(cloth).insert((
            self,
            ClothLayers::new(CLOTHES, CLOTHES | BODY | ROOM | touched),
            // All particles at any distance, so that measurements are those of the finest level.
            LodSet { pinned: Some(0), ..default() },
        ));
        // These lie on one another. The skirt is under them all, and they keep off the body by its thickness.
        if matches!(self, Self::Shirt | Self::Jacket | Self::Scarf) {
            let layered = ClothCollision { thickness: THICKNESS, ..default() };
            commands.entity(cloth).insert(layered);
        }
    }

    /// Lets go of a cloth: it falls to the ground.
    pub fn drop(commands: &mut Commands, cloth: Entity) {
        commands.entity(cloth).remove::<(Attachment, ClothSkin, SkinLimits)>();
    }
}
