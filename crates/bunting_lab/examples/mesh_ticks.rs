//! Time of a tick of an irregular mesh, flat, bent, round, with a hole or a slit, closed to a cylinder or to a funnel without
//! texture, beside that of the grid of as many particles, in turn: a lone cloth, and eight; and the time in which its fabric
//! is built.
//!
//! ```sh
//! cargo run --release -p bunting_lab --example mesh_ticks -- \
//!     COLUMNS TICKS grid|mesh|scan|both|bent|rolled|funnel|disk|holed|slit one|eight
//! ```

use std::{f32::consts::TAU, sync::Arc, time::Instant};

use anyhow::{Context, Result, bail};
use bunting_lab::{
    meshes::{Sheet, Triangulation, net},
    product::TICK,
    scenes::GRAVITY,
};
use bunting_solver::{
    ClothBatch, ClothSnapshot, Drive, FabricBuilder, FabricMaterial, Grid, LaneCount, StepLimits,
    StepSettings, instruction_set,
};
use glam::{DVec2, Vec3};

/// Ticks that are timed together, so that grid and mesh meet the same load of the machine.
const BLOCK: usize = 10;

/// Cloths of one fabric in a wind, and the times of their ticks, s.
struct Timed {
    name: String,
    batch: ClothBatch,
    /// Time in which the fabric was built, s.
    build_time: f64,
    settings: StepSettings,
    particles: usize,
    times: Vec<f64>,
}

impl Timed {
    fn new(name: &str, builder: FabricBuilder, lanes: LaneCount) -> Result<Self> {
        let start = Instant::now();
        let fabric = if name == "grid" { Arc::new(builder.build()?) } else { net(&builder) };
        let build_time = start.elapsed().as_secs_f64();
        let mut batch = ClothBatch::new(Arc::clone(&fabric), lanes);
        for cloth in 0..lanes.get() {
            let wind = Vec3::new(6.0, 0.0, 0.9 + 0.1 * cloth as f32);
            let lane =
                batch.insert(&ClothSnapshot::at_rest(&fabric), FabricMaterial::FLAG_POLYESTER)?;
            batch.drive(lane, Drive { wind, ..Drive::default() })?;
        }
        let settings = StepLimits::default().of_fabric(&fabric, TICK, GRAVITY as f32);
        let particles = fabric.particle_count() * lanes.get();
        Ok(Self { name: name.into(), batch, build_time, settings, particles, times: Vec::new() })
    }

    fn run_block(&mut self) {
        let start = Instant::now();
        (0..BLOCK).for_each(|_| self.batch.step(TICK, self.settings));
        self.times.push(start.elapsed().as_secs_f64() / BLOCK as f64);
    }

    /// Prints the least time of a tick in any block: what else runs on the machine only adds to it.
    fn print(&self) {
        let least = self.times.iter().copied().fold(f64::INFINITY, f64::min);
        println!(
            "{}: built in {:.0} ms; {:.1} µs, {:.1} ns a particle at {} × {}",
            self.name,
            self.build_time * 1e3,
            least * 1e6,
            least * 1e9 / self.particles as f64,
            self.settings.substeps,
            self.settings.passes,
        );
    }
}

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [columns, ticks, kinds, lanes] = &arguments[..] else {
        bail!("COLUMNS TICKS grid|mesh|scan|both|bent|rolled|funnel|disk|holed|slit one|eight")
    };
    let n: usize = columns.parse().context("COLUMNS")?;
    let lanes = if lanes == "one" { LaneCount::One } else { LaneCount::Eight };
    let mut timed = Vec::new();
    if kinds == "bent" {
        let sheet = Sheet::new(Triangulation::Quads, [n, n], DVec2::ONE, 1);
        let mesh = FabricBuilder::new(sheet.bent(0.5), sheet.indices);
        timed.push(Timed::new("bent", mesh.pin_where(|at, _| at.y == 0.0), lanes)?);
    }
    if kinds == "rolled" || kinds == "funnel" {
        let sheet = Sheet::new(Triangulation::Quads, [n, n], DVec2::ONE, 1);
        let wide = |at: &Vec3| if kinds == "funnel" { 1.0 - at.y } else { 1.0 };
        let roll = |at: Vec3| Vec3::new(at.x * wide(&at), at.y, at.z * wide(&at));
        let positions = sheet.bent(1.0 / TAU).into_iter().map(roll).collect();
        let mesh = FabricBuilder::new(positions, sheet.indices).weld_distance(1e-5);
        timed.push(Timed::new(kinds, mesh.pin_where(|at, _| at.y == 0.0), lanes)?);
    }
    if kinds == "holed" {
        let sheet = Sheet::new(Triangulation::Delaunay, [n, n], DVec2::ONE, 1);
        let mesh = sheet.with_hole(0.15);
        timed.push(Timed::new("holed", mesh.pin_where(|at, _| at.x == 0.0), lanes)?);
    }
    if kinds == "slit" {
        let sheet = Sheet::new(Triangulation::Quads, [n, n], DVec2::ONE, 1).with_slit();
        let mesh = FabricBuilder::new(sheet.positions, sheet.indices);
        timed.push(Timed::new("slit", mesh.pin_where(|at, _| at.y == 0.0), lanes)?);
    }
    if kinds == "disk" {
        let sheet = Sheet::new(Triangulation::Delaunay, [n, n], DVec2::ONE, 1);
        let mesh = FabricBuilder::new(sheet.round(0.56), sheet.indices);
        timed.push(Timed::new("disk", mesh.pin_where(|at, _| at.y > 0.45), lanes)?);
    }
    if kinds == "scan" {
        let sheet = Sheet::new(Triangulation::Scan, [n, n], DVec2::ONE, 1);
        let mesh = FabricBuilder::new(sheet.positions, sheet.indices);
        timed.push(Timed::new("scan", mesh.pin_where(|at, _| at.x == 0.0), lanes)?);
    }
    if kinds == "grid" || kinds == "both" {
        let grid = FabricBuilder::grid(Grid::new(n as u32, n as u32, 1.0, 1.0));
        timed.push(Timed::new("grid", grid.pin_where(|at, _| at.x == 0.0), lanes)?);
    }
    if kinds == "mesh" || kinds == "both" {
        let sheet = Sheet::new(Triangulation::Delaunay, [n, n], DVec2::ONE, 1);
        let mesh = FabricBuilder::new(sheet.positions, sheet.indices);
        timed.push(Timed::new("mesh", mesh.pin_where(|at, _| at.x == 0.0), lanes)?);
    }
    for _ in 0..ticks.parse::<usize>().context("TICKS")?.div_ceil(BLOCK) {
        timed.iter_mut().for_each(Timed::run_block);
    }
    println!("{}", instruction_set());
    timed.iter().for_each(Timed::print);
    Ok(())
}
