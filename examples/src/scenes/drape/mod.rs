//! A curtain on a rail and a sheet on a table.

mod curtain;
#[cfg(feature = "render")]
mod draw;
mod table;

use std::f32::consts::PI;

use crate::limits::{Limit, LimitRecord, greatest};
use crate::strain::Strain;
use crate::{Example, Record};
use bevy::ecs::schedule::ScheduleLabel;
use bevy::prelude::*;
use bevy_bunting::prelude::*;
use bunting_solver::LinkFamily;

/// Position of the viewer, m.
const EYE: Vec3 = Vec3::new(1.9, 1.6, 3.1);

/// The point at which the viewer looks, m.
const CENTRE: Vec3 = Vec3::new(-0.05, 0.98, -0.2);

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

impl Example for Drape {
    const NAME: &'static str = "Drape";
    const SECONDS: f64 = 12.0;

    fn build(&self, app: &mut App, schedule: impl ScheduleLabel) {
        app.add_systems(schedule, blow);
        let mut commands = app.world_mut().commands();
        let view = Transform::from_translation(EYE).looking_at(CENTRE, Vec3::Y);
        commands.spawn((LodViewer::default(), view));
        commands.spawn((Draught, WindField::default()));
        curtain::spawn(&mut commands);
        table::spawn(&mut commands);
    }

    fn record(&self, _ticks_per_second: usize) -> impl Record {
        LimitRecord::new(measure)
    }

    #[cfg(feature = "render")]
    fn stage(&self) -> crate::render::stage::Stage {
        crate::render::stage::Stage::SMALL
    }

    #[cfg(feature = "render")]
    fn draw(&self, app: &mut App) {
        app.add_plugins(draw::plugin);
    }

    #[cfg(feature = "render")]
    fn control(&self, app: &mut App) {
        crate::render::control_orbit(app, EYE, CENTRE);
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

/// Strain of the cloths, distance of the curtain from its rings, and depth of the sheet in the table.
fn measure(world: &mut World) -> Vec<Limit> {
    let [mut strain, mut off] = [0.0_f32; 2];
    for state in world.query::<&ClothState>().iter(world) {
        let Some(fabric) = state.fabric() else { continue };
        let mut cloth = Strain::default();
        cloth.add(state, LinkFamily::Warp);
        cloth.add(state, LinkFamily::Weft);
        strain = greatest([strain, cloth.mean() as f32]);
        for (particle, rest) in fabric.rest_positions().iter().enumerate() {
            if fabric.is_pinned(particle) {
                off = greatest([off, rest.distance(state.positions()[particle])]);
            }
        }
    }
    let depth = table::depth(world);
    vec![
        Limit { name: "mean strain of a cloth", value: strain, limit: STRAIN_LIMIT },
        Limit { name: "distance of the curtain from its rings, m", value: off, limit: 0.0 },
        Limit { name: "depth of the sheet in the table, m", value: depth, limit: DEPTH_LIMIT },
    ]
}
