//! A convoy of avian's rigid bodies over rough ground: each vehicle has a flag, the first one a tarpaulin over its
//! load.

#[cfg(feature = "render")]
mod draw;
mod ground;
mod suspension;
mod vehicle;
mod wheel;

use crate::limits::{Limit, LimitRecord, greatest};
use crate::scenes::convoy::vehicle::{Load, SPEED, Tarpaulin, Vehicle};
use crate::strain::greatest_mean;
use crate::{Example, Record};
use avian3d::prelude::{Collider, LinearVelocity, PhysicsPlugins};
use bevy::ecs::schedule::ScheduleLabel;
use bevy::prelude::*;
use bevy_bunting::prelude::*;
use bevy_bunting_avian::ClothAvianPlugin;

/// Position of the viewer relative to the middle of the convoy, m, and the point at which it looks.
const EYE: Vec3 = Vec3::new(12.8, 2.8, 7.6);
const CENTRE: Vec3 = Vec3::new(3.0, 1.5, -0.5);

/// Greatest mean strain of a cloth. Cloths that do not go along with their vehicles are stretched further.
const STRAIN_LIMIT: f32 = 0.03;

/// Greatest difference of a vehicle's speed from that of the convoy, m/s.
const SPEED_LIMIT: f32 = 3.0;

/// Greatest depth of the tarpaulin in the load, m: it is drawn above it by its thickness.
const DEPTH_LIMIT: f32 = 0.02;

/// A convoy over rough ground.
#[derive(Clone, Copy, Debug)]
pub struct Convoy;

impl Example for Convoy {
    const NAME: &'static str = "Convoy";
    const SECONDS: f64 = 10.0;

    fn build(&self, app: &mut App, schedule: impl ScheduleLabel) {
        app.add_plugins((PhysicsPlugins::default(), ClothAvianPlugin::default()))
            .add_systems(FixedUpdate, (suspension::carry, suspension::steer).chain())
            .add_systems(schedule, follow)
            .add_observer(vehicle::feel_edges);
        let mut commands = app.world_mut().commands();
        commands.spawn((LodViewer::default(), Transform::default()));
        commands.spawn(WindField::steady(Vec3::new(0.0, 0.0, -2.0)).with_gusts(1.0, 0.5, 7));
        ground::spawn(&mut commands);
        vehicle::spawn(&mut commands);
    }

    fn record(&self, _ticks_per_second: usize) -> impl Record {
        LimitRecord::new(measure)
    }

    #[cfg(feature = "render")]
    fn stage(&self) -> crate::render::stage::Stage {
        draw::STAGE
    }

    #[cfg(feature = "render")]
    fn draw(&self, app: &mut App) {
        app.add_plugins(draw::plugin);
    }

    #[cfg(feature = "render")]
    fn control(&self, app: &mut App) {
        app.add_plugins(crate::render::keys::gizmos);
    }
}

/// The viewer stays beside the middle of the convoy.
fn follow(
    vehicles: Query<&Transform, With<Vehicle>>,
    mut viewer: Single<&mut Transform, (With<LodViewer>, Without<Vehicle>)>,
) {
    let count = vehicles.iter().len() as f32;
    let along = vehicles.iter().map(|vehicle| vehicle.translation.x).sum::<f32>() / count;
    let middle = Vec3::X * along;
    **viewer = Transform::from_translation(middle + EYE).looking_at(middle + CENTRE, Vec3::Y);
}

/// Strain of the cloths, speed of the vehicles, and depth of the tarpaulin in the load.
fn measure(world: &mut World) -> Vec<Limit> {
    let mut vehicles = world.query_filtered::<&LinearVelocity, With<Vehicle>>();
    let speeds = vehicles.iter(world).map(|velocity| (velocity.length() - SPEED).abs());
    let speed = greatest(speeds);
    vec![
        Limit { name: "mean strain of a cloth", value: greatest_mean(world), limit: STRAIN_LIMIT },
        Limit { name: "speed less 25 m/s, m/s", value: speed, limit: SPEED_LIMIT },
        Limit { name: "depth of the tarpaulin, m", value: depth(world), limit: DEPTH_LIMIT },
    ]
}

/// Greatest depth of the tarpaulin's particles in the load, m.
fn depth(world: &mut World) -> f32 {
    let mut loads = world.query_filtered::<(&Collider, &Transform, &ChildOf), With<Load>>();
    let mut cloths = world.query_filtered::<(&ClothState, &Transform), With<Tarpaulin>>();
    let (Ok((load, in_truck, truck)), Ok((state, frame))) =
        (loads.single(world), cloths.single(world))
    else {
        return f32::NAN;
    };
    let truck = world.get::<Transform>(truck.0).copied().unwrap_or_default();
    let pose = truck * *in_truck;
    let in_load = |&at: &Vec3| {
        let at = frame.transform_point(at);
        let (nearest, is_inside) = load.project_point(pose.translation, pose.rotation, at, false);
        if is_inside { nearest.distance(at) } else { 0.0 }
    };
    greatest(state.positions().iter().map(in_load))
}
