//! Item 2: frames of uneven length do not shake the cloth of an evenly moving target.

use std::time::Duration;

use bevy_app::prelude::*;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_time::{Time, TimeUpdateStrategy};
use bevy_transform::prelude::*;
use bunting_tests::{FLAG, app, greatest_speed, state};

use super::strain;

/// Speed of the pole, m/s.
const SPEED: f32 = 20.0;

/// Number of frames, with a mean length of 1/60 s.
const FRAMES: usize = 1800;

/// Number of flags, which differ by their seeds.
const FLAGS: u32 = 16;

/// Measurements of a ride at constant speed.
#[derive(Debug)]
struct Ride {
    /// Mean over time of the mean strain.
    strain: f32,
    /// Mean over time of the greatest speed in the flag's frame, m/s.
    speed: f32,
}

/// Rides along x, with frames whose lengths vary by at most the fraction `jitter`.
fn ride(jitter: f32) -> Ride {
    #[derive(Component)]
    struct Pole;
    let mut app = app();
    // The wind makes the flag flutter out of its plane.
    app.world_mut().spawn(WindField::steady(Vec3::new(0.0, 0.0, 2.0)));
    let pole = app.world_mut().spawn((Pole, Transform::default())).id();
    // The means of one flag over half a minute of flutter differ by some percent from another's.
    let flags: Vec<Entity> = (0..FLAGS)
        .map(|seed| {
            let held = Attachment::new(pole, ClothEdge::Left);
            app.world_mut().spawn((FLAG, held, ClothSeed(seed))).id()
        })
        .collect();
    app.add_systems(Update, |mut poles: Query<&mut Transform, With<Pole>>, time: Res<Time>| {
        for mut pole in &mut poles {
            pole.translation.x -= SPEED * time.delta_secs();
        }
    });
    let mut ride = Ride { strain: 0.0, speed: 0.0 };
    let mut random = 1_u32;
    for frame in 0..FRAMES {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let uneven = (random >> 8) as f32 / (1 << 23) as f32 - 1.0;
        let frame_length = Duration::from_secs_f32((1.0 + jitter * uneven) / 60.0);
        app.insert_resource(TimeUpdateStrategy::ManualDuration(frame_length));
        app.update();
        let drawn = app.world().get::<GlobalTransform>(flags[0]).expect("placed").translation();
        let pole = app.world().get::<Transform>(pole).expect("it stays").translation;
        if frame > 0 {
            assert!(drawn.distance(pole) < 1e-5, "off its pole by {} m", drawn.distance(pole));
            assert_eq!(state(&app, flags[0]).positions()[0], Vec3::ZERO);
        }
        if frame >= FRAMES / 3 {
            ride.strain += flags.iter().map(|&flag| strain(&app, flag).mean).sum::<f32>();
            ride.speed += flags.iter().map(|&flag| greatest_speed(&app, flag)).sum::<f32>();
        }
    }
    let counted = FLAGS as f32 * (FRAMES - FRAMES / 3) as f32;
    Ride { strain: ride.strain / counted, speed: ride.speed / counted }
}

#[test]
fn uneven_frames_look_like_even_ones() {
    let even = ride(0.0);
    for jitter in [0.03, 0.1, 0.2] {
        let uneven = ride(jitter);
        let (strain, speed) = (uneven.strain / even.strain, uneven.speed / even.speed);
        assert!((strain - 1.0).abs() < 0.05, "± {jitter}: {uneven:?}, even: {even:?}");
        assert!((speed - 1.0).abs() < 0.05, "± {jitter}: {uneven:?}, even: {even:?}");
    }
}
