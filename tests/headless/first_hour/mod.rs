//! Regression tests of the defects that newcomers met in their first hour.

mod attachment;
mod clone;
mod course;
mod gusts;
mod jitter;
mod plane;
mod platform;
mod scale;
mod scene;
mod sharp_edges;
mod spawning;
mod teleport;
mod terrain;
mod tick_length;

use bevy_app::App;
use bevy_bunting::bunting_solver::LinkFamily;
use bevy_ecs::prelude::*;
use bunting_tests::state;

/// Strain of the links along warp and weft, |l/l₀ − 1|.
#[derive(Clone, Copy, Debug, Default)]
struct Strain {
    mean: f32,
    greatest: f32,
}

/// The strain of a cloth after the last tick.
fn strain(app: &App, cloth: Entity) -> Strain {
    let state = state(app, cloth);
    let fabric = state.fabric().expect("a fabric");
    let links = fabric.links().iter();
    let structural =
        links.filter(|link| matches!(link.family, LinkFamily::Warp | LinkFamily::Weft));
    let strains: Vec<f32> = structural
        .map(|link| {
            let [from, to] = link.particles.map(|particle| state.positions()[particle as usize]);
            (from.distance(to) / link.rest_length - 1.0).abs()
        })
        .collect();
    Strain {
        mean: strains.iter().sum::<f32>() / strains.len() as f32,
        greatest: strains.iter().copied().fold(0.0, f32::max),
    }
}
