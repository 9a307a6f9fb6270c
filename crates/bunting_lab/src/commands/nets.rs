//! Time of garments, beside that of a grid: alone, and in eight lanes.

use std::{sync::Arc, time::Instant};

use bunting_solver::{
    ClothBatch, Drive, Fabric, FabricBuilder, FabricMaterial, Grid, LaneCount, StepLimits,
    StepSettings,
};
use glam::Vec3;
use serde::Serialize;
use serde_json::json;

use crate::{
    flight::almost_at_rest,
    meshes::{clothes::Garment, net},
    output::{
        Outcome,
        table::{Table, figure},
    },
    product::TICK,
    scenes::ticks,
};

/// Rounds over all cloths, of which the fastest ones count, and ticks in a round.
const ROUNDS: usize = 40;
const TICKS: u32 = 5;
/// Time before anything is measured, s.
const SETTLING: f64 = 2.0;
/// Wind, m/s.
const WIND: Vec3 = Vec3::new(1.5, 0.5, 5.8);
/// Standard gravity, m/s².
const GRAVITY: f32 = 9.81;

/// Least times of a cloth.
#[derive(Clone, Debug, Serialize)]
struct Row {
    name: &'static str,
    particles: usize,
    substeps: u32,
    /// Cloths side by side.
    cloths: usize,
    /// µs a tick of all of them.
    tick_us: f64,
    /// ns for each particle of a cloth and substep.
    ns: f64,
    /// The same over that of a grid.
    over_grid: f64,
}

/// Measures garments of about a thousand particles and a grid of 33 × 33 in turn.
#[must_use]
pub fn run() -> Outcome {
    let grid = FabricBuilder::grid(Grid::new(33, 33, 1.0, 1.0));
    let grid = grid.pin_where(|at, _| at.y == 0.0).build().expect("a good fabric");
    let mut fabrics = vec![("grid of 33 × 33", Arc::new(grid))];
    fabrics.extend(Garment::all().iter().map(|garment| (garment.name, net(&garment.builder()))));
    let mut flights: Vec<Flight> = [LaneCount::One, LaneCount::Eight]
        .iter()
        .flat_map(|lanes| fabrics.iter().map(|(name, fabric)| Flight::new(name, fabric, *lanes)))
        .collect();
    for _ in 0..ROUNDS {
        flights.iter_mut().for_each(Flight::measure);
    }
    let rows: Vec<Row> = flights.chunks(fabrics.len()).flat_map(rows).collect();
    let cells = |row: &Row| {
        let counts = [row.cloths, row.particles, row.substeps as usize].map(|it| it.to_string());
        let figures = [row.tick_us, row.ns, row.over_grid].map(figure);
        core::iter::once(row.name.to_owned()).chain(counts).chain(figures).collect()
    };
    let table = Table {
        name: "nets".into(),
        title: "Garments beside a grid, in 6 m/s".into(),
        headers: vec![
            "cloth",
            "cloths",
            "particles",
            "substeps",
            "µs a tick",
            "ns a particle and substep",
            "× grid",
        ],
        rows: rows.iter().map(cells).collect(),
    };
    Outcome { json: json!({ "nets": &rows }), tables: vec![table], plots: Vec::new() }
}

/// The rows of flights, of which the first one is that of the grid.
fn rows(flights: &[Flight]) -> impl Iterator<Item = Row> {
    let of_grid = flights[0].nanoseconds();
    flights.iter().map(move |flight| Row {
        name: flight.name,
        particles: flight.batch.fabric().particle_count(),
        substeps: flight.settings.substeps,
        cloths: flight.batch.occupied().count(),
        tick_us: 1e6 * flight.least,
        ns: flight.nanoseconds(),
        over_grid: flight.nanoseconds() / of_grid,
    })
}

/// Cloths of one fabric in wind.
struct Flight {
    name: &'static str,
    batch: ClothBatch,
    settings: StepSettings,
    /// Least time of a tick, s.
    least: f64,
}

impl Flight {
    /// As many cloths as there are lanes, after some time in wind.
    fn new(name: &'static str, fabric: &Arc<Fabric>, lanes: LaneCount) -> Self {
        let mut batch = ClothBatch::new(Arc::clone(fabric), lanes);
        while !batch.is_full() {
            let start = almost_at_rest(fabric);
            let lane = batch.insert(&start, FabricMaterial::FLAG_POLYESTER).expect("a good cloth");
            batch.drive(lane, Drive { wind: WIND, ..Drive::default() }).expect("a good drive");
        }
        let settings = StepLimits::default().of_fabric(fabric, TICK, GRAVITY);
        (0..ticks(SETTLING)).for_each(|_| batch.step(TICK, settings));
        Self { name, batch, settings, least: f64::INFINITY }
    }

    fn measure(&mut self) {
        for _ in 0..TICKS {
            let begun = Instant::now();
            self.batch.step(TICK, self.settings);
            self.least = self.least.min(begun.elapsed().as_secs_f64());
        }
    }

    /// Time of a particle of one cloth in a substep, ns.
    fn nanoseconds(&self) -> f64 {
        let particles = self.batch.fabric().particle_count() * self.batch.occupied().count();
        1e9 * self.least / particles as f64 / f64::from(self.settings.substeps)
    }
}
