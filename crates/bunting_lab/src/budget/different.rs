//! Hundreds of meshes, each of its own, before a camera that moves: does the budget hold where no two cloths share anything?

use std::f32::consts::TAU;

use bevy_app::App;
use bevy_bunting::{
    Attachment, ClothBudget, ClothEdge, ClothMesh, ClothTimings, LodReport, LodSet, LodViewer,
};
use bevy_transform::components::Transform;
use glam::{Vec2, Vec3};
use serde::Serialize;

use crate::{game, scenes::TICK_RATE, settings::steps_of_levels, timing::Timing};

/// Numbers of meshes.
const COUNTS: [usize; 2] = [200, 500];
/// The same of a quick measurement.
const QUICK_COUNT: usize = 40;
/// Levels of each.
const LEVELS: usize = 3;
/// Meshes in a row, and the distances of meshes and rows, m.
const ROW: usize = 50;
const APART: Vec2 = Vec2::new(1.0, 2.0);
/// Part of the distance of vertices by which those inside are displaced.
const DISPLACED: f32 = 0.4;
/// Length of the measurement, s, and of the camera's way from one side to the other and back.
const SECONDS: usize = 15;
/// Longest time that meshes may take to be built, s.
const LONGEST: usize = 60;

/// The costs of different meshes.
#[derive(Clone, Debug, Serialize)]
pub struct Different {
    /// Number of meshes.
    pub meshes: usize,
    /// The budget of a tick, ms.
    pub ms_budget: f64,
    /// 95th percentile of the plugin's ticks while the meshes are built, and the slowest of them after the first, ms.
    pub ms_building: [f64; 2],
    /// Time until all have been built, s; none if some never are.
    pub seconds_to_all: Option<f64>,
    /// Median and 95th percentile of the plugin's ticks after that, ms.
    pub ms: [f64; 2],
    /// Numbers of cloths that are simulated and that are held still, means.
    pub simulated_and_still: [f64; 2],
}

/// Spawns the meshes at once and measures in real time, since fabrics are built on another thread.
#[must_use]
pub fn measure(quick: bool) -> Vec<Different> {
    let counts = if quick { &[QUICK_COUNT][..] } else { &COUNTS };
    counts.iter().map(|&count| of_count(count, if quick { 1 } else { SECONDS })).collect()
}

fn of_count(meshes: usize, seconds: usize) -> Different {
    let mut app = game::app_in_wind(steps_of_levels());
    app.update();
    let viewer = app.world_mut().spawn((LodViewer::default(), place(0.0))).id();
    (0..meshes).for_each(|index| spawn(&mut app, index));
    app.update();
    let (mut building, mut seconds_to_all) = (Timing::default(), None);
    for tick in 0..LONGEST * TICK_RATE as usize {
        building.push(game::update_in_real_time(&mut app) * 1e6);
        if game::built(&mut app) == meshes {
            seconds_to_all = Some((tick + 1) as f64 / f64::from(TICK_RATE));
            break;
        }
    }
    let (mut times, mut cloths) = (Timing::default(), [0.0; 2]);
    let ticks = seconds * TICK_RATE as usize;
    for tick in 0..ticks {
        *app.world_mut().get_mut::<Transform>(viewer).expect("the camera stays") =
            place(tick as f32 / ticks as f32);
        app.update();
        times.push(app.world().resource::<ClothTimings>().total().as_secs_f64() * 1e6);
        let report = app.world().resource::<LodReport>();
        let simulated = report.efforts.iter().sum::<usize>();
        cloths[0] += simulated as f64 / ticks as f64;
        cloths[1] += report.over_budget as f64 / ticks as f64;
    }
    Different {
        meshes,
        ms_budget: app.world().resource::<ClothBudget>().tick.as_secs_f64() * 1e3,
        ms_building: [0.95, 1.0].map(|part| building.percentile(part) / 1e3),
        seconds_to_all,
        ms: [0.5, 0.95].map(|part| times.percentile(part) / 1e3),
        simulated_and_still: cloths,
    }
}

/// Where the viewer is after a part of its way.
fn place(part: f32) -> Transform {
    let (sine, cosine) = (libm::sinf(TAU * part), libm::cosf(TAU * part));
    Transform::from_xyz(20.0 * sine, 2.0, 7.0 + 3.0 * cosine)
        .looking_to(Vec3::new(0.4 * sine, 0.0, -1.0), Vec3::Y)
}

fn spawn(app: &mut App, index: usize) {
    let (column, row) = ((index % ROW) as f32 - 0.5 * ROW as f32, (index / ROW) as f32);
    let place = Transform::from_xyz(APART.x * column, 3.0, -APART.y * row);
    let held = Attachment::in_place(ClothEdge::Left);
    app.world_mut().spawn((displaced(index), held, LodSet::automatic(LEVELS), place));
}

/// A sheet of other numbers of vertices and another size for each index. Its inner vertices are displaced, its texture is not: the warp is
/// bent, so that the sheet does not become a grid, as flat rectangles do.
fn displaced(index: usize) -> ClothMesh {
    let [columns, rows] = [15 + index % 7, 18 + index % 5];
    let width = 1.0 + 0.001 * index as f32;
    let (mut positions, mut uvs, mut indices) = (Vec::new(), Vec::new(), Vec::new());
    for row in 0..rows {
        for column in 0..columns {
            let noise = (column * 7919 + row * 104_729 + index * 3163) % 1000;
            let is_inner = (1..columns - 1).contains(&column) && (1..rows - 1).contains(&row);
            let part = if is_inner { DISPLACED / columns as f32 } else { 0.0 };
            let shift = part * (noise as f32 / 1000.0 - 0.5);
            let [last_column, last_row] = [columns - 1, rows - 1];
            let uv = Vec2::new(column as f32 / last_column as f32, row as f32 / last_row as f32);
            positions.push(Vec3::new(width * (uv.x + shift), -1.2 * (uv.y - shift), 0.0));
            uvs.push(uv);
        }
    }
    for row in 0..rows - 1 {
        for column in 0..columns - 1 {
            let corner = (row * columns + column) as u32;
            let below = corner + columns as u32;
            indices.extend([corner, below, corner + 1, corner + 1, below, below + 1]);
        }
    }
    ClothMesh::triangles(positions, indices, uvs)
}
