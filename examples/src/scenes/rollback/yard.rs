//! A cart with a flag, crates, and a curtain behind them.

use std::f32::consts::FRAC_PI_2;

use avian3d::prelude::{
    AngularDamping, Collider, Friction, LinearDamping, Mass, RigidBody, SleepingDisabled,
};
use bevy::prelude::*;
use bevy_bunting::prelude::*;
use bevy_bunting_avian::FeelsCloth;
use bunting_scenes::Design;

/// Size of the cart, m, and where it starts. It looks along −z.
pub const CART: Vec3 = Vec3::new(1.2, 0.4, 2.0);
const START: f32 = -2.5;

/// Edge of a crate, m.
pub const CRATE: f32 = 0.5;

/// Middles of the crates: across the way and above the ground, m, and along the way.
const CRATES: [Vec2; 5] = [
    Vec2::new(-0.6, 0.25),
    Vec2::new(0.0, 0.25),
    Vec2::new(0.6, 0.25),
    Vec2::new(-0.3, 0.75),
    Vec2::new(0.3, 0.75),
];
const STACK: f32 = -6.0;

/// Width and height of the curtain, and its upper left corner, m.
pub const CURTAIN: Vec2 = Vec2::new(3.0, 1.6);
pub const CORNER: Vec3 = Vec3::new(-1.5, 2.1, -6.75);

/// Foot of the pole in the cart, m.
const FOOT: Vec3 = Vec3::new(0.0, 0.2, 0.9);

/// The cart.
#[derive(Component, Clone, Copy, Debug)]
pub struct Cart;

/// A crate.
#[derive(Component, Clone, Copy, Debug)]
pub struct Crate;

/// The flag's pole, along y.
#[derive(Component, Clone, Copy, Debug)]
pub struct Pole;

impl Pole {
    /// Length, m.
    pub const LENGTH: f32 = 1.8;
}

/// Spawns the yard.
pub fn spawn(commands: &mut Commands) {
    commands.spawn(WindField::steady(Vec3::new(1.0, 0.0, 0.5)).with_gusts(1.0, 0.5, 3));
    let ground = (RigidBody::Static, Collider::cuboid(60.0, 1.0, 60.0));
    commands.spawn((ground, Transform::from_xyz(0.0, -0.5, 0.0)));
    let cart = (
        Cart,
        body(CART, 120.0),
        (Friction::new(0.1), LinearDamping(0.3), AngularDamping(3.0)),
        Transform::from_xyz(0.0, 0.5 * CART.y, START),
    );
    let cart = commands.spawn(cart).id();
    let middle = Transform::from_translation(FOOT + 0.5 * Pole::LENGTH * Vec3::Y);
    let pole = commands.spawn((Pole, middle, ChildOf(cart))).id();
    // The flag flies backwards.
    let top = Transform::from_xyz(0.0, 0.5 * Pole::LENGTH, 0.0)
        .with_rotation(Quat::from_rotation_y(-FRAC_PI_2));
    commands.spawn((
        ClothMesh::grid(25, 17, 1.2, 0.8),
        ClothMaterial::FLAG_POLYESTER,
        Attachment::new(pole, ClothEdge::Left).with_offset(top),
        Design::Bars(vec![[235, 180, 60], [30, 60, 110], [235, 180, 60]]),
    ));
    for at in CRATES {
        let place = Transform::from_translation(at.extend(STACK));
        commands.spawn((Crate, body(Vec3::splat(CRATE), 4.0), place));
    }
    commands.spawn((
        ClothMesh::grid(33, 19, CURTAIN.x, CURTAIN.y),
        ClothMaterial::COTTON,
        Attachment::in_place(ClothEdge::Top),
        Transform::from_translation(CORNER),
        Design::Pales(vec![[150, 40, 45], [170, 60, 60]]),
    ));
}

/// A box of this size (m) and mass (kg) that feels cloth.
fn body(size: Vec3, mass: f32) -> impl Bundle {
    let collider = Collider::cuboid(size.x, size.y, size.z);
    (RigidBody::Dynamic, SleepingDisabled, collider, Mass(mass), FeelsCloth::default())
}
