//! The smallest app that draws cloth: a flag on the pole of a truck that drives in circles.
//!
//! `cargo run --release --example hello_flag --features render`

use bevy::prelude::*;
use bevy_bunting::prelude::*;

#[derive(Component)]
struct Truck;

fn main() {
    // Folder of this repository's assets; an app usually has its assets in `assets`, Bevy's default.
    let assets = AssetPlugin { file_path: "../assets".to_owned(), ..default() };
    App::new()
        .add_plugins((DefaultPlugins.set(assets), ClothPlugins::default()))
        .add_systems(Startup, spawn)
        .add_systems(Update, drive)
        .run();
}

fn spawn(
    mut commands: Commands,
    assets: Res<AssetServer>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let view = Transform::from_xyz(0.0, 7.0, 22.0).looking_at(Vec3::Y, Vec3::Y);
    commands.spawn((Camera3d::default(), view));
    commands.spawn((DirectionalLight::default(), view));
    commands.spawn(WindField::steady(Vec3::new(3.0, 0.0, 1.0)).with_gusts(1.0, 0.5, 1));
    let model = WorldAssetRoot(assets.load("vehicles/truck.glb#Scene0"));
    let truck = commands.spawn((Truck, model)).id();
    let pole = Mesh3d(meshes.add(Cylinder::new(0.04, 2.8)));
    let white = MeshMaterial3d(materials.add(Color::WHITE));
    let place = Transform::from_xyz(-0.9, 2.5, 2.6);
    let pole = commands.spawn((pole, white, place, ChildOf(truck))).id();
    let red = StandardMaterial::from(Color::srgb(0.8, 0.2, 0.1));
    let cloth = StandardMaterial { double_sided: true, cull_mode: None, ..red };
    commands.spawn((
        ClothMesh::grid(33, 23, 1.5, 1.0),
        ClothMaterial::FLAG_POLYESTER,
        Attachment::new(pole, ClothEdge::Left).with_offset(Transform::from_xyz(0.0, 1.3, 0.0)),
        MeshMaterial3d(materials.add(cloth)),
    ));
}

fn drive(mut truck: Single<&mut Transform, With<Truck>>, time: Res<Time>) {
    let turn = Quat::from_rotation_y(time.elapsed_secs());
    **truck = Transform::from_translation(turn * Vec3::new(8.0, 0.0, 0.0)).with_rotation(turn);
}
