//! Printed cloth, or cloth coloured by its level of detail.

use bevy::prelude::*;
use bevy_bunting::prelude::*;
use bunting_examples::{print, stage};
use bunting_scenes::Design;

/// Which design is printed on a cloth.
#[derive(Component, Clone, Copy, Debug)]
pub struct Print(pub usize);

/// Whether cloth is coloured by level.
#[derive(Resource, Clone, Copy, Debug, PartialEq, Eq)]
pub struct ByLevel(pub bool);

/// Colours of the levels, the finest first, and of what is asleep.
const LEVEL_COLOURS: [Srgba; 5] = [
    Srgba::rgb(0.15, 0.65, 0.25),
    Srgba::rgb(0.95, 0.85, 0.20),
    Srgba::rgb(0.95, 0.50, 0.10),
    Srgba::rgb(0.80, 0.15, 0.15),
    Srgba::rgb(0.45, 0.45, 0.50),
];

/// Materials of all cloths: few, so that they are drawn together.
#[derive(Resource, Debug)]
struct Dyes {
    prints: Vec<Handle<StandardMaterial>>,
    levels: Vec<Handle<StandardMaterial>>,
}

/// Dresses cloths, and dresses them anew when their level changes.
pub fn plugin(app: &mut App) {
    app.add_systems(Startup, mix).add_systems(Update, dye);
}

fn mix(
    mut commands: Commands,
    mut images: ResMut<Assets<Image>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let prints = designs().map(|design| {
        let picture = images.add(print::picture(&design, Vec2::new(1.2, 0.8)));
        materials.add(StandardMaterial { base_color_texture: Some(picture), ..stage::bunting() })
    });
    let levels = LEVEL_COLOURS.map(|colour| {
        materials.add(StandardMaterial { base_color: colour.into(), ..stage::bunting() })
    });
    commands.insert_resource(Dyes { prints: prints.to_vec(), levels: levels.to_vec() });
}

fn designs() -> [Design; 6] {
    let [orange, cream, slate, plum, gold, teal, lilac] = [
        [225, 95, 45],
        [245, 240, 225],
        [35, 75, 90],
        [85, 45, 100],
        [235, 180, 60],
        [20, 105, 110],
        [200, 180, 220],
    ];
    // Of no country.
    [
        Design::Pales(vec![orange, cream, slate, cream, orange]),
        Design::Bars(vec![plum, lilac, plum, lilac]),
        Design::Cross { field: teal, cross: cream },
        Design::Disc { field: gold, disc: plum },
        Design::Chequers { colours: [orange, cream], rows: 4 },
        Design::Pales(vec![slate, gold]),
    ]
}

fn dye(
    mut commands: Commands,
    cloths: Query<(Entity, &Print, &ClothState, Option<&MeshMaterial3d<StandardMaterial>>)>,
    dyes: Res<Dyes>,
    by_level: Res<ByLevel>,
) {
    for (cloth, print, state, worn) in &cloths {
        let dye = if !by_level.0 {
            &dyes.prints[print.0 % dyes.prints.len()]
        } else if state.activity() == ClothActivity::Ticking {
            &dyes.levels[state.level().min(LEVEL_COLOURS.len() - 2)]
        } else {
            &dyes.levels[LEVEL_COLOURS.len() - 1]
        };
        if worn.is_none_or(|worn| worn.0 != *dye) {
            commands.entity(cloth).insert(MeshMaterial3d(dye.clone()));
        }
    }
}
