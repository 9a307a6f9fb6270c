//! The tables at the end of a run.

use crate::table::table;
use comfy_table::Table;

use crate::scenes::flags::record::FlagsRecord;

/// Budget of all cloth in a tick, ms.
const BUDGET: f64 = 1.0;

/// Greatest number of rows in the table of levels: longer runs are sampled.
const LEVEL_ROWS: usize = 20;

/// Prints all measurements.
pub fn print(record: &FlagsRecord) {
    println!("\n{}\n\n{}\n\n{}", durations(record), levels(record), strains(record));
    let within = 100.0 * record.total.fraction_within(BUDGET);
    println!("\n{within:.0} % of the ticks within {BUDGET} ms: {}", record.total.summary());
}

fn durations(record: &FlagsRecord) -> Table {
    let sets = record.sets.iter().map(|(set, durations)| (format!("{set:?}"), durations));
    let rows = sets.chain([("whole tick".to_owned(), &record.total)]).map(|(name, durations)| {
        let [median, high] = [0.5, 0.95].map(|part| format!("{:.4}", durations.quantile(part)));
        [name, median, high]
    });
    table(["set", "median, ms", "95 %, ms"], rows)
}

fn levels(record: &FlagsRecord) -> Table {
    let particles = record.particles.iter().map(|count| format!("{count} × {count}"));
    let header = ["after, s".to_owned()].into_iter().chain(particles);
    let step = record.counts.len().div_ceil(LEVEL_ROWS).max(1);
    let rows = (1..).zip(&record.counts).step_by(step);
    table(header, rows.map(|(second, counts)| [second].into_iter().chain(counts.iter().copied())))
}

fn strains(record: &FlagsRecord) -> Table {
    let percent = |strain: f64| format!("{:.3}", 100.0 * strain);
    let rows = [("warp", &record.warp), ("weft", &record.weft)].map(|(name, strain)| {
        [name.to_owned(), percent(strain.mean()), percent(strain.greatest().into())]
    });
    table(["strain along the", "mean, %", "greatest, %"], rows)
}
