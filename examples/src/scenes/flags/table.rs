//! The tables at the end of a run.

use crate::table::table;
use comfy_table::Table;

use crate::scenes::flags::measurements::Measurements;

/// Budget of all cloth in a tick, ms.
const BUDGET: f64 = 1.0;

/// Greatest number of rows in the table of levels: longer runs are sampled.
const LEVEL_ROWS: usize = 20;

/// Prints all measurements.
pub fn print(measured: &Measurements) {
    println!("\n{}\n\n{}\n\n{}", durations(measured), levels(measured), strains(measured));
    let within = 100.0 * measured.total.fraction_within(BUDGET);
    println!("\n{within:.0} % of the ticks within {BUDGET} ms: {}", measured.total.summary());
}

fn durations(measured: &Measurements) -> Table {
    let sets = measured.sets.iter().map(|(set, durations)| (format!("{set:?}"), durations));
    let rows = sets.chain([("whole tick".to_owned(), &measured.total)]).map(|(name, durations)| {
        let [median, high] = [0.5, 0.95].map(|part| format!("{:.4}", durations.quantile(part)));
        [name, median, high]
    });
    table(["set", "median, ms", "95 %, ms"], rows)
}

fn levels(measured: &Measurements) -> Table {
    let particles = measured.particles.iter().map(|count| format!("{count} × {count}"));
    let header = ["after, s".to_owned()].into_iter().chain(particles);
    let step = measured.counts.len().div_ceil(LEVEL_ROWS).max(1);
    let rows = (1..).zip(&measured.counts).step_by(step);
    table(header, rows.map(|(second, counts)| [second].into_iter().chain(counts.iter().copied())))
}

fn strains(measured: &Measurements) -> Table {
    let percent = |strain: f64| format!("{:.3}", 100.0 * strain);
    let rows = [("warp", &measured.warp), ("weft", &measured.weft)].map(|(name, strain)| {
        [name.to_owned(), percent(strain.mean()), percent(strain.greatest().into())]
    });
    table(["strain along the", "mean, %", "greatest, %"], rows)
}
