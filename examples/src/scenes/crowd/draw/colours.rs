//! Colours cloth by its design or by its level of detail.

use crate::render::title::Title;
use crate::render::{print, stage};
use bevy::prelude::*;
use bevy_bunting::prelude::*;
use bunting_scenes::Design;

/// Whether cloths are coloured by level.
#[derive(Resource, Clone, Copy, Debug, PartialEq, Eq)]
struct ByLevel(bool);

/// Size of each print, m; the size of a flag.
const PRINT_SIZE: Vec2 = Vec2::new(1.2, 0.8);

/// Colours of the levels, the finest first.
const LEVEL_COLOURS: [Srgba; 4] = [
    Srgba::rgb(0.15, 0.65, 0.25),
    Srgba::rgb(0.95, 0.85, 0.20),
    Srgba::rgb(0.95, 0.50, 0.10),
    Srgba::rgb(0.80, 0.15, 0.15),
];

/// Colour of cloth that is asleep.
const ASLEEP_COLOUR: Srgba = Srgba::rgb(0.45, 0.45, 0.50);

/// The materials of all cloths; a small number, so that many cloths are drawn together.
#[derive(Resource, Debug)]
struct Materials {
    prints: Vec<Handle<StandardMaterial>>,
    levels: Vec<Handle<StandardMaterial>>,
    asleep: Handle<StandardMaterial>,
}

/// The printed material of a cloth.
#[derive(Component, Clone, Debug)]
struct Print(Handle<StandardMaterial>);

/// Gives cloths materials, coloured by level at the start or not.
pub fn plugin(by_level: bool) -> impl Plugin {
    move |app: &mut App| {
        app.insert_resource(ByLevel(by_level))
            .add_systems(Startup, create_materials)
            .add_systems(Update, (assign_prints, assign_materials).chain());
    }
}

/// L switches between designs and levels.
pub fn control(app: &mut App) {
    app.add_systems(Update, |keys: Res<ButtonInput<KeyCode>>, mut by_level: ResMut<ByLevel>| {
        if keys.just_pressed(KeyCode::KeyL) {
            by_level.0 = !by_level.0;
        }
    });
    Title::add_keys(app, "L: levels");
}

fn create_materials(
    mut commands: Commands,
    mut images: ResMut<Assets<Image>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let prints = designs().map(|design| {
        let image = images.add(print::image(&design, PRINT_SIZE));
        materials.add(StandardMaterial { base_color_texture: Some(image), ..stage::flag_cloth() })
    });
    let mut plain = |colour: Srgba| {
        materials.add(StandardMaterial { base_color: colour.into(), ..stage::flag_cloth() })
    };
    commands.insert_resource(Materials {
        prints: prints.to_vec(),
        levels: LEVEL_COLOURS.map(&mut plain).to_vec(),
        asleep: plain(ASLEEP_COLOUR),
    });
}

/// Designs that are no country's flag.
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
    [
        Design::Pales(vec![orange, cream, slate, cream, orange]),
        Design::Bars(vec![plum, lilac, plum, lilac]),
        Design::Cross { field: teal, cross: cream },
        Design::Disc { field: gold, disc: plum },
        Design::Chequers { colours: [orange, cream], rows: 4 },
        Design::Pales(vec![slate, gold]),
    ]
}

fn assign_prints(
    mut commands: Commands,
    cloths: Query<Entity, Added<ClothState>>,
    materials: Res<Materials>,
) {
    for (cloth, print) in cloths.iter().zip(materials.prints.iter().cycle()) {
        commands.entity(cloth).insert(Print(print.clone()));
    }
}

fn assign_materials(
    mut commands: Commands,
    cloths: Query<(Entity, &Print, &ClothState, Option<&MeshMaterial3d<StandardMaterial>>)>,
    materials: Res<Materials>,
    by_level: Res<ByLevel>,
) {
    for (cloth, Print(print), state, current) in &cloths {
        let material = if !by_level.0 {
            print
        } else if state.activity() == ClothActivity::Ticking {
            &materials.levels[state.level().min(LEVEL_COLOURS.len() - 1)]
        } else {
            &materials.asleep
        };
        if current.is_none_or(|current| current.0 != *material) {
            commands.entity(cloth).insert(MeshMaterial3d(material.clone()));
        }
    }
}
