//! A lone flag of 33 × 33 whose layers are kept apart or not, without an app: a program for profilers.
//!
//! ```sh
//! cargo run --release -p bunting_lab --example lone_flag -- WIND TICKS apart|free
//! ```

use std::{sync::Arc, time::Instant};

use anyhow::{Context, Result, bail};
use bunting_lab::product::{DEFAULT, TICK};
use bunting_solver::{
    ClothBatch, ClothSnapshot, Drive, FabricBuilder, FabricMaterial, Grid, LaneCount, SelfCollision,
};
use glam::Vec3;

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [wind, ticks, layers] = &arguments[..] else { bail!("WIND TICKS apart|free") };
    let wind: f32 = wind.parse().context("WIND")?;
    let grid = FabricBuilder::grid(Grid::new(33, 33, 1.0, 1.0));
    let fabric = Arc::new(grid.pin_where(|_, uv| uv.x == 0.0).build()?);
    let mut start = ClothSnapshot::at_rest(&fabric);
    for (particle, at) in start.positions.iter_mut().enumerate() {
        at.z += 1e-4 * ((particle * 7919 % 1000) as f32 / 1000.0 - 0.5);
    }
    let mut batch = ClothBatch::new(Arc::clone(&fabric), LaneCount::One);
    batch.insert(&start, FabricMaterial::FLAG_POLYESTER)?;
    if layers == "apart" {
        batch.set_self_collision(0, Some(SelfCollision { thickness: 5e-3 }))?;
    }
    let mut times = Vec::new();
    for tick in 0..ticks.parse().context("TICKS")? {
        let time = tick as f32 * TICK;
        let gust = 1.0 + 0.25 * (2.0 * time).sin();
        let wind = wind * gust * Vec3::new(1.0, 0.0, 0.2 * (1.3 * time).sin());
        batch.drive(0, Drive { wind, ..Drive::default() })?;
        let began = Instant::now();
        batch.step(TICK, DEFAULT);
        times.push(began.elapsed().as_secs_f64() * 1e6);
    }
    times.sort_by(f64::total_cmp);
    let mean = times.iter().sum::<f64>() / times.len() as f64;
    println!("{mean:.0} µs a tick on the mean, {:.0} on the median", times[times.len() / 2]);
    Ok(())
}
