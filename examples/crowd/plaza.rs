//! The plaza: flags and banners on poles, wind, and how finely each level is solved.

use std::f32::consts::TAU;
use std::time::Duration;

use bevy::prelude::*;
use bevy_bunting::prelude::*;

use crate::colours::{ByLevel, Print};
use crate::flight;

/// Poles stand on a sunflower's spiral, k-th at this times √k from its middle, m: one on 10 m².
const SPACING: f32 = 1.8;

/// Turn from one pole to the next as a part of a full one: the golden section's.
const GOLDEN: f32 = 0.381_966;

/// Every so manyth cloth is a banner.
const BANNERS: usize = 5;

/// Levels of detail of each cloth.
pub const LEVELS: usize = 4;

/// Heights of the poles, m: the lowest, and how much the highest is higher.
const HEIGHTS: (f32, f32) = (3.2, 1.6);

/// What the plaza is to be.
#[derive(Clone, Debug)]
pub struct Crowd {
    /// Number of cloths.
    pub cloths: usize,
    /// What they may cost in a tick.
    pub budget: Duration,
    /// Whether they are coloured by level.
    pub by_level: bool,
}

/// A pole of a height in m; +y is up, and the cloth flies along +x.
#[derive(Component, Clone, Copy, Debug)]
pub struct Mast(pub f32);

impl Mast {
    /// m.
    pub const RADIUS: f32 = 0.025;
}

/// Fills a world.
pub fn build(app: &mut App, crowd: &Crowd) {
    app.insert_resource(ByLevel(crowd.by_level)).add_systems(FixedUpdate, flight::fly);
    app.world_mut().resource_mut::<ClothBudget>().tick = crowd.budget;
    let mut commands = app.world_mut().commands();
    let wind = WindField::steady(Vec3::new(5.0, 0.0, 2.0)).with_gusts(1.5, 0.4, 3);
    commands.spawn(wind);
    commands.spawn((flight::Pilot, LodViewer::default(), flight::pose(0.0)));
    for index in 0..crowd.cloths {
        spawn(&mut commands, index, wind.velocity);
    }
}

fn spawn(commands: &mut Commands, index: usize, wind: Vec3) {
    let (angle, radius) = (TAU * GOLDEN * index as f32, SPACING * (index as f32).sqrt());
    let foot = Vec3::new(radius * angle.cos(), 0.0, radius * angle.sin());
    // Any fraction that does not repeat.
    let height = HEIGHTS.0 + HEIGHTS.1 * (0.754_878 * index as f32).fract();
    let stand = Transform::from_translation(foot).looking_to(Vec3::Y.cross(wind), Vec3::Y);
    let mast = commands.spawn((Mast(height), stand)).id();
    let (mesh, edge) = if index.is_multiple_of(BANNERS) {
        (ClothMesh::grid(17, 33, 0.7, 1.4), ClothEdge::Top)
    } else {
        (ClothMesh::grid(33, 33, 1.2, 0.8), ClothEdge::Left)
    };
    let hoist = Transform::from_xyz(Mast::RADIUS, height - 0.05, 0.0);
    commands.spawn((
        mesh,
        ClothMaterial::FLAG_POLYESTER,
        LodSet::automatic(LEVELS),
        Attachment::new(mast, edge).with_offset(hoist),
        Print(index),
    ));
}
