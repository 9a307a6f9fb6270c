//! The weather: gusty wind, blasts, and a truck.

use bevy::prelude::*;
use bevy_bunting::prelude::*;

/// Wind along the road, with gusts as long as seven masts are apart.
pub const WIND: WindField = WindField::steady(Vec3::new(7.0, 0.0, 1.0)).with_gusts(4.0, 0.25, 8);

/// A blast.
const BLAST: WindBlast =
    WindBlast { front_speed: 60.0, duration: 0.4, ..WindBlast::new(25.0, 5.0) };

/// Time from one blast to the next, s.
const PERIOD: f32 = 4.0;

/// Centres of the blasts, one after the other, m.
const CENTRES: [Vec3; 3] =
    [Vec3::new(-14.0, 1.0, 10.0), Vec3::new(16.0, 1.0, -8.0), Vec3::new(2.0, 1.0, 12.0)];

/// Speed of the truck, m/s.
const SPEED: f32 = 25.0;

/// The truck drives from the negative to the positive of this x, m, and begins again.
const HALF_WAY: f32 = 90.0;

/// A truck. Its origin is in its middle.
#[derive(Component, Clone, Copy, Debug)]
pub struct Truck;

impl Truck {
    /// Height of the middle above the road, m.
    pub const HEIGHT: f32 = 1.6;
}

/// Spawns wind and truck.
pub fn spawn(commands: &mut Commands) {
    commands.spawn(WIND);
    commands.spawn((Truck, WindWake::new(6.0), Transform::from_xyz(-HALF_WAY, Truck::HEIGHT, 0.0)));
}

/// Drives the truck along the road.
pub fn drive(mut trucks: Query<&mut Transform, With<Truck>>, time: Res<Time>) {
    for mut truck in &mut trucks {
        truck.translation.x = (SPEED * time.elapsed_secs()) % (2.0 * HALF_WAY) - HALF_WAY;
    }
}

/// Lets a blast go off whenever it is time. Each is one entity.
pub fn detonate(mut commands: Commands, mut blasts: Local<usize>, time: Res<Time>) {
    let due = (time.elapsed_secs() / PERIOD) as usize;
    if *blasts < due {
        let centre = CENTRES[*blasts % CENTRES.len()];
        *blasts = due;
        commands.spawn((BLAST, Transform::from_translation(centre)));
    }
}
