//! The amount of cloth that fits in a budget of time.

use bunting_solver::instruction_set;
use serde_json::json;

use super::progress;
use crate::{
    budget::{
        different, distance, kernels, many_flags, parts, phases, plots, spawning, tables, thousand,
    },
    effort::Effort,
    output::Outcome,
    settings::{scheme_name, schemes},
};

/// Number of measurements other than [`many_flags`].
const OTHERS: usize = 7;

/// Measures many flags at once, flags at a distance, the phases and parts of a tick, kernels, and a
/// thousand flags under levels of detail.
#[must_use]
pub fn run(quick: bool) -> Outcome {
    let effort = Effort::of(quick);
    let bar = progress(many_flags::count(&effort) + OTHERS);
    bar.set_message("many flags");
    let many_flags = many_flags::measure(&effort, || bar.inc(1));
    bar.set_message("flags at a distance");
    let distances = distance::measure(quick);
    bar.inc(1);
    bar.set_message("phases");
    let phases = phases::measure(&effort);
    bar.inc(1);
    bar.set_message("parts");
    let parts = parts::measure(&effort);
    bar.inc(1);
    bar.set_message("kernels");
    let kernels = kernels::measure(&effort);
    bar.inc(1);
    bar.set_message("a thousand flags");
    let thousand = thousand::measure(quick);
    bar.inc(1);
    bar.set_message("spawning");
    let spawning = spawning::measure(quick);
    bar.inc(1);
    bar.set_message("different meshes");
    let different = different::measure(quick);
    bar.finish_and_clear();
    let mut all_plots: Vec<_> = schemes()
        .map(scheme_name)
        .iter()
        .map(|it| plots::many_flags_plot(&many_flags, it))
        .collect();
    all_plots.extend([plots::distance_plot(&distances), plots::part_plot(&parts)]);
    Outcome {
        json: json!({
            "instruction_set": instruction_set(),
            "many_flags": many_flags,
            "distances": distances,
            "phases": phases,
            "parts": parts,
            "kernels": kernels,
            "thousand": thousand,
            "spawning": spawning,
            "different": different,
        }),
        tables: vec![
            tables::eight_flags_table(&many_flags),
            tables::distance_table(&distances),
            tables::part_table(&parts),
            tables::thousand_table(&thousand),
            tables::spawning_table(&spawning),
            tables::different_table(&different),
            tables::many_flags_table(&many_flags),
            tables::phase_table(&phases),
            tables::kernel_table(&kernels),
        ],
        plots: all_plots,
    }
}
