//! The tables at the end of a run.

use comfy_table::presets::UTF8_BORDERS_ONLY;
use comfy_table::{CellAlignment, Table};

use crate::record::Record;

/// What all cloth may cost in a tick, ms.
const BUDGET: f64 = 1.0;

/// Rows in which the levels of detail are told; longer runs are told in larger steps.
const LEVEL_ROWS: usize = 20;

/// Prints everything that was measured.
pub fn print(record: &Record) {
    println!("\n{}\n\n{}\n\n{}", durations(record), levels(record), strains(record));
    let [median, high] = [0.5, 0.95].map(|part| record.total.quantile(part));
    let within = 100.0 * record.total.part_within(BUDGET);
    println!(
        "\n{within:.0} % of the ticks within {BUDGET} ms: median {median:.3} ms, 95 % {high:.3} ms"
    );
}

fn durations(record: &Record) -> Table {
    let mut table = table(["set", "median, ms", "95 %, ms"]);
    let sets = record.sets.iter().map(|(set, durations)| (format!("{set:?}"), durations));
    for (name, durations) in sets.chain([("whole tick".to_owned(), &record.total)]) {
        let [median, high] = [0.5, 0.95].map(|part| format!("{:.4}", durations.quantile(part)));
        table.add_row([name, median, high]);
    }
    numbers_right(table)
}

fn levels(record: &Record) -> Table {
    let particles = record.particles.iter().map(|count| format!("{count} × {count}"));
    let mut table = table(["after, s".to_owned()].into_iter().chain(particles));
    let seconds = record.counts.iter().enumerate();
    for (index, counts) in seconds.step_by(record.counts.len().div_ceil(LEVEL_ROWS).max(1)) {
        table.add_row([index + 1].iter().chain(counts).map(ToString::to_string));
    }
    numbers_right(table)
}

fn strains(record: &Record) -> Table {
    let mut table = table(["strain along the", "mean, %", "greatest, %"]);
    let percent = |part: f64| format!("{:.3}", 100.0 * part);
    for (name, strain) in [("warp", &record.warp), ("weft", &record.weft)] {
        table.add_row([name.to_owned(), percent(strain.mean()), percent(strain.greatest().into())]);
    }
    numbers_right(table)
}

fn table<T: Into<comfy_table::Cell>>(header: impl IntoIterator<Item = T>) -> Table {
    let mut table = Table::new();
    table
        .load_style(UTF8_BORDERS_ONLY)
        .set_header(header.into_iter().map(Into::into).collect::<Vec<_>>());
    table
}

fn numbers_right(mut table: Table) -> Table {
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table
}
