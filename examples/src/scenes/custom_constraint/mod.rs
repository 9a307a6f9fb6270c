//! A user's own force and constraint: a streamer in a swinging glass tube with a vortex of air.
//!
//! `blow` is a force: it accelerates particles towards the velocity of the vortex. `hold_inside` is a
//! constraint: it moves particles that have left the tube back to its wall. Both run in each substep, see
//! [`ClothParticles`].

use std::f32::consts::TAU;

use crate::limits::{Limit, greatest};
use crate::{OrbitExample, View};
use bevy::ecs::schedule::ScheduleLabel;
#[cfg(feature = "render")]
use bevy::light::NotShadowCaster;
use bevy::prelude::*;
use bevy_bunting::prelude::*;
use bevy_bunting::{ClothParticles, ClothSubstep, ClothSubstepSystems};
use bunting_scenes::Design;

/// Radius and height of the tube, m.
const RADIUS: f32 = 0.25;
const HEIGHT: f32 = 2.2;

/// Width and height of the streamer, m.
const WIDTH: f32 = 0.3;
const LENGTH: f32 = 1.8;

/// Angular velocity of the vortex about the world's vertical axis, rad/s, and its updraft, m/s.
const SPIN: f32 = 12.0;
const UPDRAFT: f32 = 1.5;

/// Time in which the vortex accelerates cloth to its velocity, s.
const RESPONSE: f32 = 0.2;

/// Amplitude of the tube's swing, rad, and its frequency, 1/s.
const SWING: f32 = 0.35;
const SWING_FREQUENCY: f32 = 0.4;

/// Height about which the tube swings, m.
const PIVOT: f32 = 2.6;

/// The tube, whose origin is the middle of its top.
#[derive(Component, Clone, Copy, Debug)]
struct Tube;

/// The streamer, whose frame is the tube's.
#[derive(Component, Clone, Copy, Debug)]
struct Streamer;

/// Accelerates the streamer towards the velocity of a vortex about the world's vertical axis.
fn blow(mut particles: ClothParticles, streamers: Query<Entity, With<Streamer>>) {
    for entity in &streamers {
        let Some(mut cloth) = particles.get_mut(entity) else { continue };
        for particle in 0..cloth.count() {
            let position = cloth.to_world(cloth.position(particle));
            let velocity = cloth.direction_to_world(cloth.velocity(particle));
            let vortex = SPIN * Vec3::Y.cross(position) + UPDRAFT * Vec3::Y;
            let acceleration = cloth.direction_to_local((vortex - velocity) / RESPONSE);
            cloth.add_acceleration(particle, acceleration);
        }
    }
}

/// Moves particles that have left the tube to the nearest points of its wall.
fn hold_inside(mut particles: ClothParticles, streamers: Query<Entity, With<Streamer>>) {
    for entity in &streamers {
        let Some(mut cloth) = particles.get_mut(entity) else { continue };
        for particle in 0..cloth.count() {
            let position = cloth.position(particle);
            let outwards = from_axis(position);
            if outwards.length() > RADIUS {
                let on_wall = position - outwards + RADIUS * outwards.normalize();
                cloth.set_position(particle, on_wall);
            }
        }
    }
}

/// The vector from the tube's axis to a point, both in the streamer's frame, m.
fn from_axis(point: Vec3) -> Vec3 {
    (point - 0.5 * WIDTH * Vec3::X).with_y(0.0)
}

/// A streamer in a tube.
#[derive(Clone, Copy, Debug)]
pub struct CustomConstraint;

impl OrbitExample for CustomConstraint {
    const NAME: &'static str = "Custom constraint";
    const SECONDS: f64 = 12.0;
    const VIEW: View = View { eye: Vec3::new(0.5, 1.8, 2.9), centre: Vec3::new(0.0, 1.3, 0.0) };

    fn build(app: &mut App, schedule: impl ScheduleLabel) {
        app.add_systems(schedule, swing).add_systems(
            ClothSubstep,
            (
                blow.in_set(ClothSubstepSystems::UserForces),
                hold_inside.in_set(ClothSubstepSystems::UserConstraints),
            ),
        );
        let mut commands = app.world_mut().commands();
        let tube = commands.spawn((Tube, Transform::default())).id();
        // The streamer's mesh begins at its top left corner.
        let offset = Transform::from_xyz(-0.5 * WIDTH, -0.1, 0.0);
        commands.spawn((
            Streamer,
            Name::new("Streamer"),
            ClothMesh::grid(9, 49, WIDTH, LENGTH),
            ClothMaterial::SILK,
            SelfCollision::default(),
            Attachment::new(tube, ClothEdge::Top).with_offset(offset),
            Design::Pales(vec![[196, 52, 44], [238, 232, 214], [36, 86, 140]]),
        ));
    }

    fn measure(world: &mut World) -> Vec<Limit> {
        let mut streamers = world.query_filtered::<&ClothState, With<Streamer>>();
        let positions = streamers.iter(world).flat_map(ClothState::positions);
        let distance = greatest(positions.map(|&position| from_axis(position).length()));
        // The wall holds particles up to the rounding of their coordinates.
        vec![Limit { name: "distance from the axis, m", value: distance, limit: RADIUS + 1e-5 }]
    }

    #[cfg(feature = "render")]
    fn draw(app: &mut App) {
        use crate::render::{print, stage};
        app.add_plugins(print::plugin(stage::cloth())).add_systems(PostStartup, draw_tube);
    }
}

/// Swings the tube about a horizontal axis above it.
fn swing(mut tubes: Query<&mut Transform, With<Tube>>, time: Res<Time>) {
    let angle = SWING * (TAU * SWING_FREQUENCY * time.elapsed_secs()).sin();
    for mut tube in &mut tubes {
        let rotation = Quat::from_rotation_z(angle);
        let arm = rotation * ((HEIGHT - PIVOT) * Vec3::Y);
        *tube = Transform::from_translation(PIVOT * Vec3::Y + arm).with_rotation(rotation);
    }
}

/// Draws the tube in glass.
#[cfg(feature = "render")]
fn draw_tube(
    mut commands: Commands,
    tubes: Query<Entity, With<Tube>>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let glass = StandardMaterial {
        base_color: Color::srgba(0.8, 0.9, 0.95, 0.1),
        alpha_mode: AlphaMode::Blend,
        perceptual_roughness: 0.1,
        double_sided: true,
        cull_mode: None,
        ..default()
    };
    let tube = Mesh3d(meshes.add(Cylinder::new(RADIUS + 0.01, HEIGHT)));
    let middle = Transform::from_xyz(0.0, -0.5 * HEIGHT, 0.0);
    // Light passes through glass.
    let shown = (tube, MeshMaterial3d(materials.add(glass)), middle, NotShadowCaster);
    for entity in &tubes {
        commands.entity(entity).insert(Visibility::default()).with_child(shown.clone());
    }
}
