//! Meshes of OBJ and glTF files as cloths: resampled, hung by their upper end, blown about, and dropped onto a ball.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
    time::Instant,
};

use anyhow::{Context, Result};
use bunting_solver::{
    ClothBatch, ClothSnapshot, Drive, Fabric, FabricBuilder, FabricMaterial, LaneCount, LinkFamily,
    Resolution, StepLimits,
};
use glam::{Vec2, Vec3};
use serde_json::json;

use crate::{
    flight::almost_at_rest,
    need::Need,
    output::{Outcome, table::Table, table::figure},
    product::{TICK, rms_speed},
    scenes::ticks,
    stats::{mean, percentile},
};

/// Height of the box of each mesh after scaling, m: files have units of their own.
const HEIGHT: f32 = 1.0;
/// Part of the height from the top in which vertices are held.
const HELD: f32 = 0.02;
/// Fabric of all cloths.
const CLOTH: FabricMaterial = FabricMaterial {
    area_density: 0.2,
    warp_stiffness: 1e4,
    weft_stiffness: 1e4,
    shear_stiffness: 200.0,
    bend_stiffness: 2e-5,
    ..FabricMaterial::FLAG_POLYESTER
};

/// A mesh of a file.
struct FileMesh {
    positions: Vec<Vec3>,
    uv: Vec<Vec2>,
    indices: Vec<u32>,
}

/// Measures all meshes of a folder.
///
/// # Errors
///
/// The folder cannot be read.
pub fn run(folder: &Path, filter: Option<&str>) -> Result<Outcome> {
    let entries = folder.read_dir().with_context(|| format!("cannot read {}", folder.display()))?;
    let mut paths: Vec<PathBuf> = entries.filter_map(|it| Some(it.ok()?.path())).collect();
    paths.sort();
    let is_mesh = |path: &PathBuf| {
        path.extension().is_some_and(|it| ["obj", "glb", "gltf"].iter().any(|of| it == *of))
    };
    let mut rows = Vec::new();
    for path in paths.iter().filter(|path| is_mesh(path)) {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if filter.is_some_and(|part| !name.contains(part)) {
            continue;
        }
        let row = match read(path) {
            Ok(mesh) => measured(&name, mesh),
            Err(error) => refused(&name, &error.to_string()),
        };
        eprintln!("{}", row.join("  "));
        rows.push(row);
    }
    let table = Table {
        name: "files".into(),
        title: "Meshes of files, resampled".into(),
        headers: HEADERS.to_vec(),
        rows,
    };
    Ok(Outcome { json: json!({ "files": &table.rows }), tables: vec![table], plots: Vec::new() })
}

const HEADERS: [&str; 13] = [
    "file",
    "vertices",
    "triangles",
    "nodes",
    "built ms",
    "substeps",
    "hung mean |e| %",
    "hung 99.9 %",
    "nodes < .95 %",
    "shown < .8 %",
    "hung mm/s",
    "blown 99.9 %",
    "us a tick",
];

fn refused(name: &str, why: &str) -> Vec<String> {
    let mut row = vec![name.to_owned(), why.to_owned()];
    row.resize(HEADERS.len(), String::new());
    row
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

fn measured(name: &str, FileMesh { mut positions, uv, indices }: FileMesh) -> Vec<String> {
    let [low, high] = bounds(&positions);
    let scale = HEIGHT / (high.y - low.y).max(f32::MIN_POSITIVE);
    positions.iter_mut().for_each(|at| *at = (*at - low) * scale);
    let begun = Instant::now();
    let builder = FabricBuilder::new(positions, indices).uv(uv);
    let builder = match builder.repair() {
        Ok((builder, _)) => builder,
        Err(error) => return refused(name, &error.to_string()),
    };
    let builder = builder.pin_where(|at, _| at.y > HEIGHT * (1.0 - HELD));
    let given = builder.positions().to_vec();
    let triangles: Vec<[u32; 3]> = builder.indices().as_chunks::<3>().0.to_vec();
    let count = builder.particle_count() as u32;
    let resampled = match builder.resampled(Resolution::Particles(count)) {
        Ok(resampled) => resampled,
        Err(error) => return refused(name, &error.to_string()),
    };
    let built = begun.elapsed().as_secs_f64() * 1e3;
    let fabric = resampled.fabric;
    let nodes = fabric.triangles().to_vec();
    let settings = StepLimits::default().of_fabric(&fabric, TICK, 9.81);

    let hung_material = FabricMaterial { damping: 2.0, ..CLOTH };
    let (hung, mut batch) = flown(&fabric, hung_material, Drive::default(), 4.0);
    let shown = resampled.carried.positions(&hung);
    let mut strains = strains(&fabric, &hung);
    let sizes: Vec<f64> = strains.iter().map(|it| it.abs()).collect();
    strains.sort_by(f64::total_cmp);
    let speed = rms_speed(&batch, 0);
    let wind = Vec3::new(1.5, 0.5, 5.8);
    let (blown, _) = flown(&fabric, CLOTH, Drive { wind, ..Drive::default() }, 3.0);
    let mut in_wind = self::strains(&fabric, &blown);
    in_wind.sort_by(f64::total_cmp);
    let mut best = f64::INFINITY;
    for _ in 0..50 {
        let begun = Instant::now();
        batch.step(TICK, settings);
        best = best.min(begun.elapsed().as_secs_f64() * 1e6);
    }
    vec![
        name.to_owned(),
        given.len().to_string(),
        triangles.len().to_string(),
        fabric.particle_count().to_string(),
        format!("{built:.1}"),
        settings.substeps.to_string(),
        figure(100.0 * mean(&sizes)),
        figure(100.0 * percentile(&strains, 0.999)),
        figure(below(&nodes, fabric.rest_positions(), &hung, 0.95)),
        figure(below(&triangles, &given, &shown, 0.8)),
        figure(1e3 * speed),
        figure(100.0 * percentile(&in_wind, 0.999)),
        figure(best),
    ]
}

/// The positions after some seconds by need, m.
fn flown(
    fabric: &Arc<Fabric>,
    material: FabricMaterial,
    drive: Drive,
    seconds: f64,
) -> (Vec<Vec3>, ClothBatch) {
    let mut batch = ClothBatch::new(Arc::clone(fabric), LaneCount::One);
    let start: ClothSnapshot = almost_at_rest(fabric);
    let mut positions = start.positions.clone();
    batch.insert(&start, material).expect("a good cloth");
    batch.drive(0, drive).expect("a good drive");
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

/// Strain of each link of warp and weft.
fn strains(fabric: &Fabric, positions: &[Vec3]) -> Vec<f64> {
    let links = fabric.links().iter().filter(|link| link.family != LinkFamily::Diagonal);
    let strain = |ends: [u32; 2], rest: f32| {
        let [a, b] = ends.map(|at| positions[at as usize]);
        f64::from(a.distance(b) / rest) - 1.0
    };
    links.map(|link| strain(link.particles, link.rest_length)).collect()
}

/// Triangles with less than a part of their area at rest, %.
fn below(triangles: &[[u32; 3]], rest: &[Vec3], positions: &[Vec3], part: f32) -> f64 {
    let area = |corners: &[u32; 3], of: &[Vec3]| {
        let [a, b, c] = corners.map(|at| of[at as usize]);
        (b - a).cross(c - a).length()
    };
    let count = triangles.iter().filter(|it| area(it, positions) < part * area(it, rest)).count();
    100.0 * count as f64 / triangles.len() as f64
}
