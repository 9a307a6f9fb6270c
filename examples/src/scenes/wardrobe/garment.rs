//! The pieces of clothing, and how they are put on and taken off.

use bevy::prelude::*;
use bevy_bunting::prelude::*;
use bunting_scenes::Design;

use crate::figure::cloak;
use crate::figure::skeleton::Joint;
use crate::scenes::wardrobe::layers::{ARMS, BARE, BODY, CLOTHES, ROOM, SKIRTED};
use crate::scenes::wardrobe::tailor::Cut;

/// A piece of clothing.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
pub enum Garment {
    Skirt,
    Shirt,
    Jacket,
    Scarf,
    Cape,
}

/// A long skirt, wide enough for steps of a run.
const SKIRT: Cut = Cut {
    rings: &[[1.04, 0.155, 0.122], [0.94, 0.195, 0.140], [0.26, 0.430, 0.430]],
    opening: 0.0,
    vertices: [65, 33],
    held_above: 1.03,
};

/// A shirt without sleeves, over the skirt.
const SHIRT: Cut = Cut {
    rings: &[
        [1.480, 0.080, 0.075],
        [1.455, 0.150, 0.085],
        [1.390, 0.200, 0.115],
        [1.280, 0.200, 0.138],
        [1.100, 0.185, 0.145],
        [0.960, 0.230, 0.175],
        [0.880, 0.260, 0.210],
    ],
    opening: 0.0,
    vertices: [41, 25],
    held_above: 1.38,
};

/// A jacket without sleeves, which is open in front.
const JACKET: Cut = Cut {
    rings: &[
        [1.490, 0.095, 0.095],
        [1.470, 0.160, 0.105],
        [1.390, 0.220, 0.140],
        [1.280, 0.226, 0.165],
        [1.100, 0.220, 0.180],
        [0.960, 0.265, 0.215],
        [0.830, 0.310, 0.260],
    ],
    opening: 0.5,
    vertices: [41, 25],
    held_above: 1.38,
};

/// Woollen cloth.
const WOOL: FabricMaterial =
    FabricMaterial { area_density: 0.25, bend_stiffness: 5e-5, ..FabricMaterial::COTTON };

/// Distance of clothes from one another, m.
const THICKNESS: f32 = 0.006;

impl Garment {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Skirt, Self::Shirt, Self::Jacket, Self::Scarf, Self::Cape];

    /// Spawns it on the joints of a figure.
    pub fn put_on(self, commands: &mut Commands, joints: &[Entity]) {
        let joint = |joint: Joint| (joints[joint.index()], joint);
        let (hips, chest) = (joint(Joint::Hips), joint(Joint::Chest));
        let garment = match self {
            Self::Skirt => sew(commands, hips, &SKIRT, 960, FabricMaterial::COTTON, SKIRT_PRINT),
            Self::Shirt => sew(commands, chest, &SHIRT, 220, FabricMaterial::COTTON, SHIRT_PRINT),
            Self::Jacket => sew(commands, chest, &JACKET, 260, WOOL, JACKET_PRINT),
            Self::Scarf => knit(commands, chest),
            Self::Cape => cloak::spawn(commands, joints, 21),
        };
        let touched = match self {
            Self::Skirt => BARE,
            Self::Shirt | Self::Jacket => SKIRTED,
            Self::Scarf | Self::Cape => SKIRTED | ARMS,
        };
        if matches!(self, Self::Shirt | Self::Jacket | Self::Scarf) {
            let collision = ClothCollision { thickness: THICKNESS, ..default() };
            commands.entity(garment).insert(collision);
        }
        commands.entity(garment).insert((
            self,
            ClothLayers::new(CLOTHES, CLOTHES | BODY | ROOM | touched),
            // All particles at any distance, so that measurements are those of the finest level.
            LodSet { pinned: Some(0), ..default() },
        ));
    }

    /// Lets go of a cloth: it falls to the ground.
    pub fn drop(commands: &mut Commands, garment: Entity) {
        commands.entity(garment).remove::<(Attachment, ClothSkin, SkinLimits)>();
    }
}

type Stripes = [[u8; 3]; 2];

const SKIRT_PRINT: Stripes = [[46, 84, 128], [58, 100, 146]];
const SHIRT_PRINT: Stripes = [[226, 218, 200], [226, 218, 200]];
const JACKET_PRINT: Stripes = [[92, 96, 62], [92, 96, 62]];
const SCARF_PRINT: Stripes = [[190, 60, 40], [222, 168, 60]];

/// Spawns a tube that is held by a bone.
fn sew(
    commands: &mut Commands,
    (bone, joint): (Entity, Joint),
    cut: &Cut,
    particles: u32,
    material: FabricMaterial,
    stripes: Stripes,
) -> Entity {
    let held = Attachment::new(bone, cut.held());
    let cloth = commands.spawn((
        cut.mesh(),
        ClothResolution::Particles(particles),
        ClothMaterial(material),
        held.with_offset(Transform::from_translation(-joint.place())),
        Design::Pales(stripes.repeat(16)),
    ));
    cloth.id()
}

/// Spawns a scarf that is held at the neck and hangs down the back.
fn knit(commands: &mut Commands, (chest, joint): (Entity, Joint)) -> Entity {
    let nape = Vec3::new(-0.07, 1.475, 0.125) - joint.place();
    let cloth = commands.spawn((
        ClothMesh::grid(5, 17, 0.14, 0.75),
        ClothMaterial(WOOL),
        Attachment::new(chest, ClothEdge::Top).with_offset(Transform::from_translation(nape)),
        Design::Bars(SCARF_PRINT.repeat(5)),
    ));
    cloth.id()
}
