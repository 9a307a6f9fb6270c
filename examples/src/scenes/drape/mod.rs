//! A curtain on a rail and a sheet on a table.

mod curtain;
#[cfg(feature = "render")]
mod draw;
mod table;

use std::f32::consts::PI;

use crate::limits::{Limit, greatest};
use crate::strain::greatest_mean;
use crate::{OrbitExample, View};
use bevy::ecs::schedule::ScheduleLabel;
use bevy::prelude::*;
use bevy_bunting::prelude::*;

/// Time from one gust to the next, s: the first gust begins when all cloths have come to rest.
const PERIOD: f32 = 5.0;

/// Duration of a gust, s.
const GUST: f32 = 1.6;

/// Greatest speed of a gust, m/s.
const GUST_SPEED: f32 = 3.2;

/// Limit of the mean strain of each cloth: larger strain would be visible.
const STRAIN_LIMIT: f32 = 0.01;

/// Limit of a particle's depth in the table, m: rounding, and the distance that contacts permit.
const DEPTH_LIMIT: f32 = 1e-3;

/// A gusty wind, as through an open door.
#[derive(Component, Clone, Copy, Debug)]
struct Draught;

/// A curtain and a sheet.
#[derive(Clone, Copy, Debug)]
pub struct Drape;

impl OrbitExample for Drape {
    const NAME: &'static str = "Drape";
    const SECONDS: f64 = 12.0;
    const VIEW: View = View { eye: Vec3::new(1.9, 1.6, 3.1), centre: Vec3::new(-0.05, 0.98, -0.2) };

    fn build(app: &mut App, schedule: impl ScheduleLabel) {
        app.add_systems(schedule, blow);
        let mut commands = app.world_mut().commands();
        commands.spawn((Draught, WindField::default()));
        curtain::spawn(&mut commands);
        table::spawn(&mut commands);
    }

    /// Strain of the cloths, distance of the curtain from its rings, and depth of the sheet in the table.
    fn measure(world: &mut World) -> Vec<Limit> {
        let mut off = 0.0_f32;
        for state in world.query::<&ClothState>().iter(world) {
            let Some(fabric) = state.fabric() else { continue };
            for (particle, rest) in fabric.rest_positions().iter().enumerate() {
                if fabric.is_pinned(particle) {
                    off = greatest([off, rest.distance(state.positions()[particle])]);
                }
            }
        }
        let depth = table::depth(world);
        vec![
            Limit {
                name: "mean strain of a cloth",
                value: greatest_mean(world),
                limit: STRAIN_LIMIT,
            },
            Limit { name: "distance of the curtain from its rings, m", value: off, limit: 0.0 },
            Limit { name: "depth of the sheet in the table, m", value: depth, limit: DEPTH_LIMIT },
        ]
    }

    #[cfg(feature = "render")]
    fn draw(app: &mut App) {
        app.add_plugins(draw::plugin);
    }
}

/// Makes gusts rise and fall.
fn blow(mut draughts: Query<&mut WindField, With<Draught>>, time: Res<Time>) {
    let since = time.elapsed_secs() % PERIOD - (PERIOD - GUST);
    let rise = (PI * since.max(0.0) / GUST).sin();
    for mut wind in &mut draughts {
        let velocity = GUST_SPEED * rise * rise * Vec3::new(0.15, 0.0, 1.0);
        // Writing an unchanged wind would keep the cloths awake.
        if wind.velocity != velocity {
            wind.velocity = velocity;
        }
    }
}
