//! Simulates a small scene without a window.

use std::process::ExitCode;

use bevy::app::{TaskPoolOptions, TaskPoolPlugin};
use bevy::log::{Level, LogPlugin};
use bevy::prelude::*;
use bevy_bunting::ClothTimings;
use bevy_bunting::prelude::*;
use comfy_table::presets::UTF8_BORDERS_ONLY;
use comfy_table::{CellAlignment, Table};

use crate::ONE_TICK;
use crate::durations::Durations;
use crate::pictures::{self, Album};
use crate::show::{Check, Show};
use crate::stage::Stage;

/// Simulates as fast as it goes, takes pictures and prints a table. Fails if something did not hold
/// that must.
pub fn run(show: &Show, seconds: f64, album: &Album) -> ExitCode {
    let mut app = App::new();
    let mut pictures = album.open(show.name);
    let log = LogPlugin { level: Level::WARN, ..default() };
    if pictures.is_some() {
        app.add_plugins((pictures::windowless().set(log), pictures::plugin, Stage::SMALL));
        (show.dress)(&mut app);
    } else {
        let threads = TaskPoolPlugin { task_pool_options: TaskPoolOptions::with_num_threads(1) };
        app.add_plugins((MinimalPlugins.set(threads), TransformPlugin, log));
    }
    app.add_plugins(ClothPlugins::default()).insert_resource(ONE_TICK);
    (show.build)(&mut app);
    let view = Transform::from_translation(show.eye).looking_at(show.looks_at, Vec3::Y);
    app.world_mut().spawn((LodViewer::default(), view));
    app.finish();
    app.cleanup();
    if let Some(pictures) = &mut pictures {
        pictures.set_up(&mut app, Stage::SMALL.camera());
    }

    let rate = app.world().resource::<Time<Fixed>>().timestep().as_secs_f64().recip();
    let mut ticks = Durations::default();
    let mut worst: Vec<Check> = Vec::new();
    for tick in 1..=(seconds * rate).ceil() as usize {
        app.update();
        ticks.push(app.world().resource::<ClothTimings>().total());
        let checks = (show.check)(app.world_mut());
        if worst.len() == checks.len() {
            for (worst, check) in worst.iter_mut().zip(checks) {
                worst.value = worst.value.max(check.value);
            }
        } else {
            worst = checks;
        }
        if let Some(pictures) = &mut pictures {
            pictures.take_due(&mut app, tick as f64 / rate);
        }
    }
    print(&count(app.world_mut()), &ticks, &worst);
    // What is not a number holds nothing.
    if worst.iter().all(|check| check.value <= check.limit) {
        ExitCode::SUCCESS
    } else {
        eprintln!("a value is greater than it may be");
        ExitCode::FAILURE
    }
}

/// Cloths, particles and vertices.
fn count(world: &mut World) -> [usize; 3] {
    let mut counts = [0; 3];
    for (state, mesh) in world.query::<(&ClothState, &ClothMesh)>().iter(world) {
        let vertices = match mesh {
            ClothMesh::Grid { columns, rows, .. } => (columns * rows) as usize,
            ClothMesh::Triangles { positions, .. } => positions.len(),
        };
        for (count, more) in counts.iter_mut().zip([1, state.positions().len(), vertices]) {
            *count += more;
        }
    }
    counts
}

fn print([cloths, particles, vertices]: &[usize; 3], ticks: &Durations, worst: &[Check]) {
    let mut table = Table::new();
    table.load_style(UTF8_BORDERS_ONLY).set_header(["", "worst", "at most"]);
    for Check { what, value, limit } in worst {
        table.add_row([(*what).to_owned(), format!("{value:.5}"), format!("{limit}")]);
    }
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    println!("{table}\n");
    println!(
        "{cloths} cloths, {particles} particles for {vertices} vertices; a tick took {:.3} ms in the median, 95 % {:.3} ms",
        ticks.quantile(0.5),
        ticks.quantile(0.95),
    );
}
