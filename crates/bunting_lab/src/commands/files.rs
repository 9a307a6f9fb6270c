//! Meshes of OBJ and glTF files as cloths: resampled, hung by their upper end, blown about, and dropped onto a ball.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
    time::Instant,
};

use anyhow::{Context, Result};
use bunting_solver::{
    ClothBatch, ClothSnapshot, Collider, Drive, Fabric, FabricBuilder, FabricMaterial, LaneCount,
    Resampled, StepLimits,
};
use glam::{Quat, Vec2, Vec3};
use parry3d::shape::SharedShape;
use serde::Serialize;
use serde_json::json;

use crate::{
    flight::almost_at_rest,
    meshes::{clothes::FABRIC, resampled},
    need::Need,
    output::{
        Outcome,
        table::{Table, figure},
    },
    product::{TICK, rms_speed, yarn_strains},
    scenes::ticks,
    stats::{mean, percentile},
    timing::Timing,
};

/// Standard gravity, m/s².
const GRAVITY: f32 = 9.81;
/// Damping of cloth that hangs or lies, 1/s.
const DAMPING: f32 = 2.0;
/// Wind, m/s.
const WIND: Vec3 = Vec3::new(1.5, 0.5, 5.8);
/// Radius of the ball, m, and its distance below the cloth.
const BALL: f32 = 0.3;
const GAP: f32 = 0.02;
/// Time in which cloth hangs, flies, and falls onto the ball, s.
const HANGS: f64 = 4.0;
const FLIES: f64 = 3.0;
const FALLS: f64 = 2.0;
/// Ticks that are timed.
const TIMED: usize = 50;
/// Height of the box of each mesh after scaling, m: files have units of their own.
const HEIGHT: f32 = 1.0;
/// Part of the height from the top in which vertices are held.
const HELD: f32 = 0.02;
/// A mesh of a file.
struct FileMesh {
    positions: Vec<Vec3>,
    uv: Vec<Vec2>,
    indices: Vec<u32>,
}

/// A file and what its cloth did.
#[derive(Debug, Serialize)]
struct Row {
    file: String,
    /// Why there is no cloth.
    refused: Option<String>,
    figures: Option<Figures>,
}

#[derive(Debug, Serialize)]
struct Figures {
    vertices: usize,
    triangles: usize,
    /// Particles of the cloth.
    particles: usize,
    /// Time of repairing and resampling, ms.
    built_ms: f64,
    /// Substeps of the hanging cloth in a tick.
    substeps: u32,
    /// Mean size of the strain along warp and weft of the hanging cloth, %, and its 99.9 %.
    strain: f64,
    tension: f64,
    /// Simulated triangles below .95, and carried ones below .8 of their area, %.
    compressed: f64,
    carried: f64,
    /// RMS speed of the hanging cloth, mm/s. Pieces that nothing holds fall.
    speed: f64,
    /// The 99.9 % of strain in wind, and on a ball, %.
    in_wind: f64,
    on_ball: f64,
    /// Shortest time of a tick of the hanging cloth, µs.
    tick_us: f64,
}

/// Measures the meshes of a folder, or those whose names contain something.
///
/// # Errors
///
/// The folder cannot be read.
pub fn run(folder: &Path, filter: Option<&str>) -> Result<Outcome> {
    let entries = folder.read_dir().with_context(|| format!("cannot read {}", folder.display()))?;
    let mut paths: Vec<PathBuf> = entries.filter_map(|it| Some(it.ok()?.path())).collect();
    paths.sort();
    let is_mesh = |path: &&PathBuf| {
        path.extension().is_some_and(|it| ["obj", "glb", "gltf"].iter().any(|of| it == *of))
    };
    let mut rows = Vec::new();
    for path in paths.iter().filter(is_mesh) {
        let file = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if filter.is_some_and(|part| !file.contains(part)) {
            continue;
        }
        let (refused, figures) = match read(path).and_then(measured) {
            Ok(figures) => (None, Some(figures)),
            Err(error) => (Some(format!("{error:#}")), None),
        };
        rows.push(Row { file, refused, figures });
    }
    Ok(Outcome { json: json!({ "files": &rows }), tables: tables(&rows), plots: Vec::new() })
}

fn tables(rows: &[Row]) -> Vec<Table> {
    let figures = |row: &Row| {
        let of = row.figures.as_ref()?;
        let numbers = [of.vertices, of.triangles, of.particles].map(|count| count.to_string());
        let figures = [of.built_ms, of.strain, of.tension, of.compressed, of.carried, of.speed];
        let cells = core::iter::once(row.file.clone()).chain(numbers);
        let cells = cells.chain([of.substeps.to_string()]).chain(figures.map(figure));
        Some(cells.chain([of.in_wind, of.on_ball, of.tick_us].map(figure)).collect())
    };
    let refused = |row: &Row| Some(vec![row.file.clone(), row.refused.clone()?]);
    let measured = Table {
        name: "files".into(),
        title: "Meshes of files as cloths: hung by their upper end, in wind, on a ball".into(),
        headers: vec![
            "file",
            "vertices",
            "triangles",
            "particles",
            "substeps",
            "built, ms",
            "strain, %",
            "99.9 %",
            "below .95, %",
            "carried below .8, %",
            "mm/s",
            "in wind 99.9 %",
            "on a ball 99.9 %",
            "µs a tick",
        ],
        rows: rows.iter().filter_map(figures).collect(),
    };
    let left: Vec<Vec<String>> = rows.iter().filter_map(refused).collect();
    let left = Table {
        name: "files_refused".into(),
        title: "Files that are no cloths".into(),
        headers: vec!["file", "reason"],
        rows: left,
    };
    if left.rows.is_empty() { vec![measured] } else { vec![measured, left] }
}

fn read(path: &Path) -> Result<FileMesh> {
    let mut mesh = FileMesh { positions: Vec::new(), uv: Vec::new(), indices: Vec::new() };
    if path.extension().is_some_and(|it| it == "obj") {
        let (models, _) = tobj::load_obj(path, &tobj::GPU_LOAD_OPTIONS)?;
        for tobj::Model { mesh: model, .. } in models {
            let first = mesh.positions.len() as u32;
            let positions = model.positions.as_chunks::<3>().0;
            mesh.positions.extend(positions.iter().map(|at| Vec3::from(*at)));
            let mut uv: Vec<Vec2> =
                model.texcoords.as_chunks::<2>().0.iter().map(|at| Vec2::from(*at)).collect();
            uv.resize(positions.len(), Vec2::ZERO);
            mesh.uv.extend(uv);
            mesh.indices.extend(model.indices.iter().map(|index| index + first));
        }
    } else {
        let gltf::Gltf { document, blob } = gltf::Gltf::open(path)?;
        let blob = blob.context("its buffers are in other files")?;
        for primitive in document.meshes().flat_map(|mesh| mesh.primitives()) {
            let reader = primitive.reader(|_| Some(&blob[..]));
            let first = mesh.positions.len() as u32;
            let Some(positions) = reader.read_positions() else { continue };
            mesh.positions.extend(positions.map(Vec3::from));
            let count = mesh.positions.len() - first as usize;
            let mut uv: Vec<Vec2> = reader
                .read_tex_coords(0)
                .map(|uv| uv.into_f32().map(Vec2::from).collect())
                .unwrap_or_default();
            uv.resize(count, Vec2::ZERO);
            mesh.uv.extend(uv);
            match reader.read_indices() {
                Some(indices) => mesh.indices.extend(indices.into_u32().map(|it| it + first)),
                None => mesh.indices.extend(first..mesh.positions.len() as u32),
            }
        }
    }
    Ok(mesh)
}

fn measured(FileMesh { mut positions, uv, indices }: FileMesh) -> Result<Figures> {
    let [low, high] = bounds(&positions);
    let scale = HEIGHT / (high.y - low.y).max(f32::MIN_POSITIVE);
    positions.iter_mut().for_each(|at| *at = (*at - low) * scale);
    let begun = Instant::now();
    let (free, _) = FabricBuilder::new(positions, indices).uv(uv).repair()?;
    let held = free.clone().pin_where(|at, _| at.y > HEIGHT * (1.0 - HELD));
    let Resampled { fabric, carried, .. } = resampled(&held)?;
    let built_ms = begun.elapsed().as_secs_f64() * 1e3;
    let triangles = held.indices().as_chunks::<3>().0;

    let calm = FabricMaterial { damping: DAMPING, ..FABRIC };
    let (hung, mut batch) = flown(&fabric, calm, Drive::default(), &[], HANGS);
    let (strain, tension) = strains(&fabric, &hung);
    let speed = 1e3 * rms_speed(&batch, 0);
    let drive = Drive { wind: WIND, ..Drive::default() };
    let (blown, _) = flown(&fabric, FABRIC, drive, &[], FLIES);
    let dropped = resampled(&free)?.fabric;
    let [low, high] = bounds(dropped.rest_positions());
    let below = low.midpoint(high).with_y(low.y - BALL - GAP);
    let ball = Collider::fixed(SharedShape::ball(BALL), below, Quat::IDENTITY);
    let (draped, _) = flown(&dropped, calm, Drive::default(), &[ball], FALLS);

    let limits = StepLimits::default();
    let mut timing = Timing::default();
    for _ in 0..TIMED {
        timing.time(|| batch.step(TICK, limits.clone()));
    }
    Ok(Figures {
        vertices: held.positions().len(),
        triangles: triangles.len(),
        particles: fabric.particle_count(),
        built_ms,
        substeps: limits.of_fabric(&fabric, TICK, GRAVITY).substeps,
        strain,
        tension,
        compressed: share_below(fabric.triangles(), fabric.rest_positions(), &hung, 0.95),
        carried: share_below(triangles, held.positions(), &carried.positions(&hung), 0.8),
        speed,
        in_wind: strains(&fabric, &blown).1,
        on_ball: strains(&dropped, &draped).1,
        tick_us: timing.min(),
    })
}

/// The positions after some seconds by need, m.
fn flown(
    fabric: &Arc<Fabric>,
    material: FabricMaterial,
    drive: Drive,
    colliders: &[Collider],
    seconds: f64,
) -> (Vec<Vec3>, ClothBatch) {
    let mut batch = ClothBatch::new(Arc::clone(fabric), LaneCount::One);
    let start: ClothSnapshot = almost_at_rest(fabric);
    let mut positions = start.positions.clone();
    batch.insert(&start, material).expect("a good cloth");
    batch.drive(0, drive).expect("a good drive");
    batch.set_colliders(0, colliders.to_vec()).expect("good shapes");
    let mut need = Need::within(StepLimits::default());
    for _ in 0..ticks(seconds) {
        let settings = need.settings(fabric, &drive, TICK);
        batch.step(TICK, settings);
        let before = positions.clone();
        batch.copy_positions(0, &mut positions);
        need.note(&batch, &material, &drive, [&before, &positions], TICK);
    }
    (positions, batch)
}

fn bounds(positions: &[Vec3]) -> [Vec3; 2] {
    positions
        .iter()
        .fold([Vec3::INFINITY, Vec3::NEG_INFINITY], |[low, high], at| [low.min(*at), high.max(*at)])
}

/// The mean size of the strain along warp and weft, and its 99.9 %, in percent.
fn strains(fabric: &Fabric, positions: &[Vec3]) -> (f64, f64) {
    let mut strains: Vec<f64> = yarn_strains(fabric, positions).collect();
    let sizes: Vec<f64> = strains.iter().map(|it| it.abs()).collect();
    strains.sort_by(f64::total_cmp);
    (100.0 * mean(&sizes), 100.0 * percentile(&strains, 0.999))
}

/// Triangles with less than a part of their area at rest, %.
fn share_below(triangles: &[[u32; 3]], rest: &[Vec3], positions: &[Vec3], part: f32) -> f64 {
    let area = |corners: &[u32; 3], of: &[Vec3]| {
        let [a, b, c] = corners.map(|at| of[at as usize]);
        (b - a).cross(c - a).length()
    };
    let count = triangles.iter().filter(|it| area(it, positions) < part * area(it, rest)).count();
    100.0 * count as f64 / triangles.len() as f64
}
