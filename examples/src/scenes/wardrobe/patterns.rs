//! The patterns of the clothes that are tubes about the body.

use bevy::prelude::*;
use bevy_bunting::prelude::*;
use bunting_scenes::Design;

use crate::figure::skeleton::Joint;
use crate::scenes::wardrobe::cut::Cut;

/// A tube of cloth, and the bone that holds it.
#[derive(Clone, Copy, Debug)]
pub struct Pattern {
    cut: Cut,
    bone: Joint,
    /// About so many particles.
    particles: u32,
    material: FabricMaterial,
    /// Colours of stripes from top to bottom.
    stripes: [[u8; 3]; 2],
}

/// Woollen cloth.
pub const WOOL: FabricMaterial =
    FabricMaterial { area_density: 0.25, bend_stiffness: 5e-5, ..FabricMaterial::COTTON };

/// A long skirt, wide enough for the steps of a run.
pub const SKIRT: Pattern = Pattern {
    cut: Cut {
        rings: &[[1.04, 0.152, 0.122], [0.94, 0.195, 0.140], [0.26, 0.430, 0.430]],
        opening: 0.0,
        vertices: [65, 33],
        held_above: 1.03,
    },
    bone: Joint::Hips,
    particles: 960,
    material: FabricMaterial::COTTON,
    stripes: [[46, 84, 128], [58, 100, 146]],
};

/// A shirt without sleeves, over the skirt.
pub const SHIRT: Pattern = Pattern {
    cut: Cut {
        rings: &[
            [1.480, 0.080, 0.075],
            [1.455, 0.150, 0.085],
            [1.390, 0.200, 0.115],
            [1.280, 0.200, 0.138],
            [1.100, 0.185, 0.145],
            [0.930, 0.230, 0.180],
        ],
        opening: 0.0,
        vertices: [41, 25],
        held_above: 1.38,
    },
    bone: Joint::Chest,
    particles: 220,
    material: FabricMaterial::COTTON,
    stripes: [[226, 218, 200]; 2],
};

/// A jacket without sleeves, which is open in front.
pub const JACKET: Pattern = Pattern {
    cut: Cut {
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
    },
    bone: Joint::Chest,
    particles: 260,
    material: WOOL,
    stripes: [[92, 96, 62]; 2],
};

impl Pattern {
    /// Spawns the cloth on the joints of a figure.
    pub fn sew(&self, commands: &mut Commands, joints: &[Entity]) -> Entity {
        let held = Attachment::new(joints[self.bone.index()], self.cut.held());
        let cloth = commands.spawn((
            self.cut.mesh(),
            ClothResolution::Particles(self.particles),
            ClothMaterial(self.material),
            held.with_offset(Transform::from_translation(-self.bone.place())),
            Design::Pales(self.stripes.repeat(16)),
        ));
        cloth.id()
    }
}
