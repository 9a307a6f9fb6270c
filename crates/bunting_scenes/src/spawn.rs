//! Spawns the entities of a scene.

use std::collections::BTreeMap;

use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_transform::components::Transform;

use crate::scene::{Flag, Footing, Scene};
use crate::track::{LooksAt, Track};

/// A flag pole. The origin is its foot, y is up, and its flag flies along +x.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
pub struct Pole {
    /// Height, m.
    pub height: f32,
}

impl Pole {
    /// Radius of every pole, m.
    pub const RADIUS: f32 = 0.04;

    /// Distance from the top of a pole to its flag, m.
    const FREE_TOP: f32 = 0.1;
}

/// Direction of a vehicle's headwind in its frame.
const HEADWIND: Vec3 = Vec3::Z;

/// The glTF file that draws an entity, relative to `assets/`.
#[derive(Component, Clone, Debug, PartialEq, Eq)]
pub struct Model(pub String);

/// Spawns the wind, viewer, vehicles and flags of a scene. [`ClothPlugins`] move the cloths, and
/// [`follow_tracks`](crate::follow_tracks) moves the vehicles and the viewer.
pub fn spawn(commands: &mut Commands, scene: &Scene) {
    for wind in &scene.winds {
        let field = WindField::steady(wind.velocity);
        commands.spawn(field.with_gusts(wind.gust_strength, wind.gust_frequency, wind.seed));
    }
    let track = Track::new(&scene.viewer.track);
    commands.spawn((LodViewer::default(), LooksAt(scene.viewer.looks_at), track.pose(0.0), track));
    let vehicles: BTreeMap<&str, Entity> = scene
        .vehicles
        .iter()
        .map(|(name, vehicle)| {
            let track = Track::new(&vehicle.track);
            let body =
                (Name::new(name.clone()), Model(vehicle.model.clone()), track.pose(0.0), track);
            (name.as_str(), commands.spawn(body).id())
        })
        .collect();
    let wind: Vec3 = scene.winds.iter().map(|wind| wind.velocity).sum();
    for flag in &scene.flags {
        let pole = match &flag.on {
            Footing::Ground { x, z } => {
                let foot = foot(Vec3::new(*x, 0.0, *z), wind);
                commands.spawn((Pole { height: flag.pole }, foot)).id()
            }
            Footing::Vehicle(name) => {
                let foot = foot(scene.vehicles[name].socket, HEADWIND);
                commands
                    .spawn((Pole { height: flag.pole }, foot, ChildOf(vehicles[name.as_str()])))
                    .id()
            }
        };
        commands.spawn(cloth(flag, pole, scene));
    }
}

/// The frame of a pole, turned so that the flag flies with the wind.
fn foot(position: Vec3, wind: Vec3) -> Transform {
    Transform::from_translation(position).looking_to(Vec3::Y.cross(wind), Vec3::Y)
}

fn cloth(flag: &Flag, pole: Entity, scene: &Scene) -> impl Bundle {
    let hoist = Transform::from_xyz(Pole::RADIUS, flag.pole - Pole::FREE_TOP, 0.0);
    let particles = scene.levels.finest;
    (
        ClothMesh::grid(particles, particles, flag.size.x, flag.size.y),
        ClothMaterial(scene.material(&flag.material).unwrap_or_default()),
        LodSet::new(scene.levels.switch_distances.clone()),
        Attachment::new(pole, ClothEdge::Left).with_offset(hoist),
        flag.design.clone(),
    )
}
