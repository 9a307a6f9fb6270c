//! Draws the ground, posts along the way, and the vehicles, and prints the cloths.

use std::f32::consts::FRAC_PI_2;

use crate::render::stage::Stage;
use crate::render::{print, stage};
use avian3d::prelude::Collider;
use bevy::asset::RenderAssetUsages;
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::prelude::*;

use crate::scenes::convoy::ground::{Ground, LENGTH, WIDTH, height, places};
use crate::scenes::convoy::vehicle::{Load, Part, Pole, Vehicle};
use crate::scenes::convoy::wheel::{RADIUS, Wheel};

/// Sky, ground and light of a wide field.
pub const STAGE: Stage = Stage {
    ground: Color::srgb(0.46, 0.47, 0.33),
    haze: [60.0, 400.0],
    shadows: [14.0, 60.0],
    ..Stage::SMALL
};

/// Distance of the posts from the middle of the way and from one another, m.
const POSTS: (f32, f32) = (-5.0, 8.0);

/// Distance of the load's drawn surface from that which the tarpaulin lies on, m: the tarpaulin is drawn as a smooth
/// surface, which cuts edges.
const INSET: f32 = 0.03;

/// Draws the scene.
pub fn plugin(app: &mut App) {
    app.add_plugins(print::plugin(stage::flag_cloth()))
        .add_systems(PostStartup, (draw_ground, draw_posts, draw_vehicles));
}

fn draw_ground(
    mut commands: Commands,
    ground: Single<Entity, With<Ground>>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let soil = StandardMaterial {
        base_color: Color::srgb(0.52, 0.47, 0.36),
        perceptual_roughness: 1.0,
        reflectance: 0.1,
        ..default()
    };
    let at = |x: f32| places(WIDTH).map(move |z| [x, height(x, z), z]);
    let positions: Vec<[f32; 3]> = places(LENGTH).flat_map(at).collect();
    let across = u32::from(WIDTH) + 1;
    let cells = (0..u32::from(LENGTH)).flat_map(|x| (0..u32::from(WIDTH)).map(move |z| (x, z)));
    let indices = cells.flat_map(|(x, z)| {
        let here = x * across + z;
        [here, here + 1, here + across, here + 1, here + across + 1, here + across]
    });
    let mesh = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::RENDER_WORLD)
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
        .with_inserted_indices(Indices::U32(indices.collect()))
        .with_computed_smooth_normals();
    let mesh = Mesh3d(meshes.add(mesh));
    commands.entity(*ground).insert((mesh, MeshMaterial3d(materials.add(soil))));
}

fn draw_posts(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let post = meshes.add(Cuboid::new(0.12, 1.0, 0.12));
    let paint = materials.add(stage::paint());
    let (aside, spacing) = POSTS;
    for x in places(LENGTH).filter(|x| x.rem_euclid(spacing) == 0.0) {
        let foot = Transform::from_xyz(x, height(x, aside) + 0.4, aside);
        commands.spawn((Mesh3d(post.clone()), MeshMaterial3d(paint.clone()), foot));
    }
}

fn draw_vehicles(
    mut commands: Commands,
    vehicles: Query<Entity, With<Vehicle>>,
    parts: Query<(Entity, &Collider, Has<Load>), With<Part>>,
    wheels: Query<Entity, With<Wheel>>,
    poles: Query<Entity, With<Pole>>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    for vehicle in &vehicles {
        commands.entity(vehicle).insert(Visibility::default());
    }
    let paint = materials.add(StandardMaterial {
        base_color: Color::srgb(0.27, 0.35, 0.40),
        perceptual_roughness: 0.6,
        ..default()
    });
    let wood = materials.add(Color::srgb(0.55, 0.40, 0.24));
    for (part, collider, is_load) in &parts {
        let Some(shape) = collider.shape().as_cuboid() else { continue };
        let material = if is_load { wood.clone() } else { paint.clone() };
        let inset = if is_load { INSET } else { 0.0 };
        let mesh = Mesh3d(meshes.add(Cuboid::from_size(2.0 * (shape.half_extents - inset))));
        commands.entity(part).insert((mesh, MeshMaterial3d(material)));
    }
    let tyre = meshes
        .add(Mesh::from(Cylinder::new(RADIUS, 0.28)).rotated_by(Quat::from_rotation_z(FRAC_PI_2)));
    let rubber = materials.add(StandardMaterial {
        base_color: Color::srgb(0.06, 0.06, 0.06),
        perceptual_roughness: 0.95,
        ..default()
    });
    for wheel in &wheels {
        let look = (Mesh3d(tyre.clone()), MeshMaterial3d(rubber.clone()));
        commands.entity(wheel).insert(look);
    }
    let white = materials.add(stage::paint());
    let shaft = meshes.add(Cylinder::new(0.03, Pole::LENGTH));
    for pole in &poles {
        commands.entity(pole).insert((Mesh3d(shaft.clone()), MeshMaterial3d(white.clone())));
    }
}
