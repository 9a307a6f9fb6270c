//! A curtain on a rail and a sheet on a table.
//!
//! `cargo run --release --example drape` shows them; drag to look around, scroll to come closer.
//! Look at how the sheet falls into folds at the corners of the table and stays there by friction,
//! and at the curtain, which hangs by its rings in pleats and is parted by gusts at its slit. The
//! keys are those of the example `flags`.
//!
//! `cargo run --release --example drape -- --headless` simulates them as fast as it goes and prints
//! what it cost; with `--pictures DIR` it writes pictures.

mod curtain;
mod furniture;
mod table;

use std::f32::consts::PI;
use std::process::ExitCode;

use bevy::prelude::*;
use bevy_bunting::prelude::*;
use bunting_examples::show::{Check, Show};
use bunting_examples::strain::Strain;
use bunting_solver::LinkFamily;

/// Time from one gust to the next, s: the first comes when everything hangs.
const PERIOD: f32 = 5.0;

/// How long a gust lasts, s.
const GUST: f32 = 1.6;

/// Speed of a gust at its height, m/s.
const STRENGTH: f32 = 3.2;

/// Mean strain that no cloth should exceed.
const STRAIN: f32 = 0.01;

/// How deep a particle may be in the table, m: rounding.
const DEPTH: f32 = 1e-3;

/// A wind that comes in gusts through a door.
#[derive(Component, Clone, Copy, Debug)]
struct Draught;

fn main() -> ExitCode {
    let show = Show {
        name: env!("CARGO_BIN_NAME"),
        build,
        dress: |app| {
            app.add_plugins(furniture::plugin);
        },
        eye: Vec3::new(1.9, 1.6, 3.1),
        looks_at: Vec3::new(-0.05, 0.98, -0.2),
        check,
    };
    show.main()
}

/// Air, curtain, table and sheet.
fn build(app: &mut App) {
    app.add_systems(FixedUpdate, blow);
    let mut commands = app.world_mut().commands();
    commands.spawn((Draught, WindField::default()));
    curtain::hang(&mut commands);
    table::lay(&mut commands);
}

/// Lets gusts come and go.
fn blow(mut draughts: Query<&mut WindField, With<Draught>>, time: Res<Time>) {
    let since = time.elapsed_secs() % PERIOD - (PERIOD - GUST);
    let rise = (PI * since.max(0.0) / GUST).sin();
    for mut wind in &mut draughts {
        let velocity = STRENGTH * rise * rise * Vec3::new(0.15, 0.0, 1.0);
        if wind.velocity != velocity {
            wind.velocity = velocity;
        }
    }
}

/// Cloth is whole, hangs where it was hung, and is outside of the table.
fn check(world: &mut World) -> Vec<Check> {
    let (mut mean, mut off) = (0.0, 0.0_f32);
    for state in world.query::<&ClothState>().iter(world) {
        let Some(fabric) = state.fabric() else { continue };
        let mut strain = Strain::default();
        strain.add(state, LinkFamily::Warp);
        strain.add(state, LinkFamily::Weft);
        mean = strain.mean().max(mean);
        for (particle, rest) in fabric.rest_positions().iter().enumerate() {
            if fabric.is_pinned(particle) {
                off = off.max(rest.distance(state.positions()[particle]));
            }
        }
    }
    vec![
        Check { what: "mean strain of a cloth", value: mean as f32, limit: STRAIN },
        Check { what: "curtain, off its rings, m", value: off, limit: 0.0 },
        Check { what: "sheet, deep in the table, m", value: table::depth(world), limit: DEPTH },
    ]
}
