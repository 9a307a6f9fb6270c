//! Draws cart, crates, pole and the curtain's bar, and prints the cloths.

use crate::render::{print, stage};
use bevy::prelude::*;

use crate::scenes::rollback::yard::{CART, CORNER, CRATE, CURTAIN, Cart, Crate, Pole};

/// Radius of the pole and of the bar, m.
const RADIUS: f32 = 0.025;

/// Draws the yard.
pub fn plugin(app: &mut App) {
    app.add_plugins(print::plugin(stage::cloth()))
        .add_systems(PostStartup, (draw_bodies, draw_bar));
}

fn draw_bodies(
    mut commands: Commands,
    carts: Query<Entity, With<Cart>>,
    crates: Query<Entity, With<Crate>>,
    poles: Query<Entity, With<Pole>>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let green = MeshMaterial3d(materials.add(Color::srgb(0.20, 0.36, 0.30)));
    let wood = MeshMaterial3d(materials.add(Color::srgb(0.55, 0.40, 0.24)));
    let white = MeshMaterial3d(materials.add(stage::paint()));
    let cart = Mesh3d(meshes.add(Cuboid::from_size(CART)));
    let crate_ = Mesh3d(meshes.add(Cuboid::from_length(CRATE)));
    let pole = Mesh3d(meshes.add(Cylinder::new(RADIUS, Pole::LENGTH)));
    for entity in &carts {
        commands.entity(entity).insert((cart.clone(), green.clone()));
    }
    for entity in &crates {
        commands.entity(entity).insert((crate_.clone(), wood.clone()));
    }
    for entity in &poles {
        commands.entity(entity).insert((pole.clone(), white.clone()));
    }
}

fn draw_bar(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let white = materials.add(stage::paint());
    let mut spawn = |mesh: Mesh, place: Transform| {
        commands.spawn((Mesh3d(meshes.add(mesh)), MeshMaterial3d(white.clone()), place));
    };
    let along = Quat::from_rotation_z(std::f32::consts::FRAC_PI_2);
    let middle = CORNER + Vec3::new(0.5 * CURTAIN.x, RADIUS, 0.0);
    let bar = Transform::from_translation(middle).with_rotation(along);
    spawn(Cylinder::new(RADIUS, CURTAIN.x).into(), bar);
    for side in [-0.5, 0.5] {
        let post = Vec3::new(middle.x + side * CURTAIN.x, 0.5 * middle.y, middle.z);
        spawn(Cylinder::new(RADIUS, middle.y).into(), Transform::from_translation(post));
    }
}
