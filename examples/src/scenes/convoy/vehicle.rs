//! The vehicles: boxes of avian's, with flags, a load and a tarpaulin. A vehicle looks along its -z.

use std::f32::consts::FRAC_PI_2;

use avian3d::prelude::{Collider, ColliderDensity, LinearVelocity, RigidBody};
use bevy::prelude::*;
use bevy_bunting::prelude::*;
use bevy_bunting_avian::FeelsCloth;
use bunting_scenes::Design;

use crate::scenes::convoy::ground;
use crate::scenes::convoy::wheel::{Wheel, mounts};

/// Speed of the convoy, m/s.
pub const SPEED: f32 = 25.0;

/// Mass of a vehicle, kg: that of its chassis.
pub const MASS: f32 = 2_500.0;

/// Places of the vehicles at the start, m, the first one's first.
const STARTS: [Vec2; 3] = [Vec2::new(-190.0, 0.0), Vec2::new(-198.0, -1.5), Vec2::new(-206.0, 0.5)];

/// Height of a vehicle's middle above the ground at the start, m.
const RIDE: f32 = 0.76;

/// Boxes of a vehicle: middle and size, m. The load is one of the first vehicle's.
const CHASSIS: [Vec3; 2] = [Vec3::ZERO, Vec3::new(2.0, 0.4, 4.6)];
const CAB: [Vec3; 2] = [Vec3::new(0.0, 0.65, -1.6), Vec3::new(1.9, 0.9, 1.2)];
const LOAD: [Vec3; 2] = [Vec3::new(0.0, 0.6, 0.75), Vec3::new(1.4, 0.8, 2.3)];

/// Foot of the pole in a vehicle, m.
const FOOT: Vec3 = Vec3::new(0.0, 0.2, 2.2);

/// Width of the tarpaulin across the vehicle and its length, m; it hangs over the load by some centimetres.
const TARPAULIN: Vec2 = Vec2::new(3.1, 2.5);

/// Distance of the tarpaulin's lower edges from the vehicle's middle, and their height in it, m.
const RAIL: Vec2 = Vec2::new(0.97, 0.28);

/// A vehicle of the convoy.
#[derive(Component, Clone, Copy, Debug)]
pub struct Vehicle {
    /// The z on which it drives, m.
    pub lane: f32,
}

/// A box.
#[derive(Component, Clone, Copy, Debug)]
pub struct Part;

/// The load of the first vehicle.
#[derive(Component, Clone, Copy, Debug)]
pub struct Load;

/// The cloth over the load.
#[derive(Component, Clone, Copy, Debug)]
pub struct Tarpaulin;

/// A flag's pole, along y.
#[derive(Component, Clone, Copy, Debug)]
pub struct Pole;

impl Pole {
    /// Length, m.
    pub const LENGTH: f32 = 2.6;
}

/// Spawns the vehicles.
pub fn spawn(commands: &mut Commands) {
    let colours = [[225, 95, 45], [235, 180, 60], [20, 105, 110]];
    for (index, (start, colour)) in STARTS.into_iter().zip(colours).enumerate() {
        let at = Vec3::new(start.x, ground::height(start.x, start.y) + RIDE, start.y);
        let pose = Transform::from_translation(at).looking_to(Vec3::X, Vec3::Y);
        let body = (RigidBody::Dynamic, LinearVelocity(SPEED * Vec3::X));
        let vehicle = (Vehicle { lane: start.y }, body, FeelsCloth::default(), pose);
        let vehicle = commands.spawn(vehicle).id();
        let [middle, size] = CHASSIS;
        let heavy = ColliderDensity(MASS / size.element_product());
        commands.spawn((part(middle, size), heavy, ChildOf(vehicle)));
        commands.spawn((part(CAB[0], CAB[1]), ChildOf(vehicle)));
        for mount in mounts() {
            commands.spawn((Wheel(mount), Transform::from_translation(mount), ChildOf(vehicle)));
        }
        spawn_flag(commands, vehicle, colour);
        if index == 0 {
            commands.spawn((Load, part(LOAD[0], LOAD[1]), ChildOf(vehicle)));
            spawn_tarpaulin(commands, vehicle);
        }
    }
}

/// A box of a vehicle.
fn part(middle: Vec3, size: Vec3) -> impl Bundle {
    let collider = Collider::cuboid(size.x, size.y, size.z);
    (Part, collider, Transform::from_translation(middle))
}

/// The tarpaulin is laid over the edges of these boxes.
pub fn feel_edges(added: On<Add, ClothCollider>, mut parts: Query<&mut ClothCollider, With<Part>>) {
    if let Ok(mut part) = parts.get_mut(added.entity) {
        part.features = true;
    }
}

/// A flag on a pole, which flies backwards.
fn spawn_flag(commands: &mut Commands, vehicle: Entity, colour: [u8; 3]) {
    let middle = FOOT + 0.5 * Pole::LENGTH * Vec3::Y;
    let pole = (Pole, Transform::from_translation(middle), ChildOf(vehicle));
    let pole = commands.spawn(pole).id();
    let top = Transform::from_xyz(0.0, 0.5 * Pole::LENGTH, 0.0)
        .with_rotation(Quat::from_rotation_y(-FRAC_PI_2));
    commands.spawn((
        Name::new("Flag"),
        ClothMesh::grid(33, 23, 1.5, 1.0),
        ClothMaterial::FLAG_POLYESTER,
        Attachment::new(pole, ClothEdge::Left).with_offset(top),
        Design::Bars(vec![colour, [245, 240, 225], colour]),
    ));
}

/// A tarpaulin over the load: nailed to its front edge, and tied to both sides of the vehicle.
fn spawn_tarpaulin(commands: &mut Commands, vehicle: Entity) {
    let mesh = ClothMesh::grid(33, 27, TARPAULIN.x, TARPAULIN.y);
    let [middle, size] = LOAD;
    let top = middle.y + 0.5 * size.y + 0.01;
    let front = middle.z - 0.5 * TARPAULIN.y;
    // The mesh's x lies across the vehicle, its -y along it, backwards.
    let lay = |x: f32, y: f32| {
        Transform::from_xyz(x, y, front).with_rotation(Quat::from_rotation_x(-FRAC_PI_2))
    };
    let flat = 0.5 * size.x / TARPAULIN.x;
    let nailed = AttachedVertices::list_where(&mesh, |uv| uv.y < 1e-3 && (uv.x - 0.5).abs() < flat);
    let [out, low] = RAIL.to_array();
    let left = Anchor::new(vehicle, ClothEdge::Left).with_offset(lay(-out, low));
    let right = Anchor::new(vehicle, ClothEdge::Right).with_offset(lay(out - TARPAULIN.x, low));
    commands.spawn((
        Tarpaulin,
        mesh,
        ClothMaterial(FabricMaterial { area_density: 0.4, ..FabricMaterial::FLAG_POLYESTER }),
        Attachment::new(vehicle, nailed)
            .with_offset(lay(-0.5 * TARPAULIN.x, top))
            .with_anchor(left)
            .with_anchor(right),
        Design::Pales(vec![[96, 112, 78]]),
    ));
}
