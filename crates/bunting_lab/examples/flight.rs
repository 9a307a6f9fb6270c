//! Eight flags of 33 × 33 in one batch, without an app: a program for profilers.
//!
//! ```sh
//! cargo run --release -p bunting_lab --example flight -- PASSES TICKS wind|vacuum
//! ```

use anyhow::{Context, Result, bail};
use bunting_lab::{
    product::{DEFAULT, Product},
    scenes::{Air, Scene},
    simulation::Simulation,
};
use bunting_solver::{LaneCount, StepSettings, instruction_set};

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [passes, ticks, air] = &arguments[..] else { bail!("PASSES TICKS wind|vacuum") };
    let settings = StepSettings { passes: passes.parse().context("PASSES")?, ..DEFAULT };
    let mut scene = Scene::flag(33);
    if air == "vacuum" {
        scene.air = Air::VACUUM;
    }
    let mut flags = Product { settings, lanes: LaneCount::Eight }.start(&scene);
    for _ in 0..ticks.parse().context("TICKS")? {
        flags.tick();
    }
    println!("{}: the tip of the first is at {:?}", instruction_set(), flags.positions().last());
    Ok(())
}
