//! The ground, and a stool on which the figure sits.

use bevy::prelude::*;
use bevy_bunting::prelude::*;

use crate::scenes::wardrobe::layers::{CLOTHES, ROOM};
use crate::scenes::wardrobe::story::WAY;

/// Radius of the stool, m.
pub const RADIUS: f32 = 0.17;

/// Height of the stool, m: there is a gap for the skirt between it and the figure.
pub const HEIGHT: f32 = 0.43;

/// Distance of the stool behind the feet, m.
const BEHIND: f32 = 0.42;

/// Distance that clothes keep from the room, m.
const MARGIN: f32 = 0.008;

/// A stool.
#[derive(Component)]
pub struct Stool;

/// Spawns the room.
pub fn spawn(commands: &mut Commands) {
    let layers = ClothLayers::new(ROOM, CLOTHES);
    commands.spawn((ClothCollider { margin: MARGIN, ..ClothCollider::ground() }, layers));
    let seat = ClothCollider {
        margin: MARGIN,
        friction: 0.2,
        ..ClothCollider::cylinder(0.5 * HEIGHT, RADIUS)
    };
    // The figure turns its back to where it came from.
    let place = Transform::from_xyz(0.0, 0.5 * HEIGHT, -(WAY.length() + BEHIND));
    commands.spawn((Stool, seat, layers, place));
}
