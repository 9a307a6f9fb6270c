//! The curtain, which hangs by rings on a rail.

use bevy::prelude::*;
use bevy_bunting::prelude::*;
use bunting_scenes::Design;

/// Vertices in a row and in a column.
const COLUMNS: u32 = 65;
const ROWS: u32 = 33;

/// Vertices from one ring to the next.
const PITCH: u32 = 4;

/// Width and height of the curtain, m.
pub const WIDTH: f32 = 2.6;
pub const HEIGHT: f32 = 1.95;

/// Length of the rail, m.
pub const RAIL: f32 = 2.65;

/// Left end of the rail, where the first ring is fixed, m.
pub const END: Vec3 = Vec3::new(-1.3, 2.1, 0.0);

/// Mass of a ring, kg.
const RING_MASS: f32 = 0.01;

/// Friction coefficient of the rings on the rail.
const FRICTION: f32 = 0.12;

/// Colour.
const LINEN: [u8; 3] = [132, 66, 58];

/// Spawns the rail and the curtain.
pub fn spawn(commands: &mut Commands) -> Entity {
    let rail = commands.spawn(Transform::from_translation(END)).id();
    let first = AttachedVertices::List(vec![0]);
    let others = AttachedVertices::List(rings().skip(1).collect());
    let hold = AnchorHold::Rail {
        points: vec![Vec3::ZERO, RAIL * Vec3::X],
        ring_mass: RING_MASS,
        friction: FRICTION,
    };
    let rings = Anchor::new(rail, others).with_hold(hold);
    let cloth = (
        Name::new("Curtain"),
        ClothMesh::grid(COLUMNS, ROWS, WIDTH, HEIGHT),
        ClothMaterial(FabricMaterial { area_density: 0.2, ..FabricMaterial::COTTON }),
        Attachment::new(rail, first).with_anchor(rings),
        LodSet { pinned: Some(0), ..LodSet::default() },
        SelfCollision::default(),
        Design::Bars(vec![LINEN]),
    );
    commands.spawn(cloth).id()
}

/// The vertices that hang on rings.
pub fn rings() -> impl Iterator<Item = u32> {
    (0..COLUMNS).step_by(PITCH as usize)
}
