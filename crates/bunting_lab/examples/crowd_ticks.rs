//! A thousand flags through the plugin, with fixed costs: a program for profilers.
//!
//! ```sh
//! cargo run --release -p bunting_lab --example crowd_ticks -- WARM_UP TICKS
//! ```

use anyhow::{Context, Result, bail};
use bevy_bunting::{ClothSystems, CostTable, LodCosts};
use bunting_lab::{budget::thousand::Field, settings::steps_of_levels};

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [warm_up, ticks] = &arguments[..] else { bail!("WARM_UP TICKS") };
    let steps = steps_of_levels();
    let mut field = Field::new(&steps, LodCosts::Fixed(CostTable::default()));
    field.advance(warm_up.parse().context("WARM_UP")?);
    let measured = field.measure(ticks.parse().context("TICKS")?, &steps);
    for (set, ms) in ClothSystems::ORDER.iter().zip(&measured.ms_per_set) {
        println!("{set:?} {ms:.4} ms");
    }
    println!(
        "choice {:.4} ms, tick {:.4} ms, {:.2} changes",
        measured.ms_choice_median, measured.ms_tick_median, measured.changes_per_tick
    );
    println!("flags by level {:.0?}, {:.0} asleep", measured.per_level, measured.asleep);
    Ok(())
}
