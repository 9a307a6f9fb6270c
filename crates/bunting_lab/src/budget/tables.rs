//! The budget's figures as tables.

use bevy_bunting::ClothSystems;
use bunting_solver::instruction_set;

use super::{
    different::Different,
    distance::AtDistance,
    kernels::Kernels,
    many_flags::ManyFlags,
    parts::{EXTRAS, Part},
    phases::Phase,
    spawning::Spawning,
    thesis,
    thousand::Thousand,
};
use crate::{
    output::table::{Table, figure},
    settings::LEVELS,
};

/// Table of every number of flags at every level.
#[must_use]
pub fn many_flags_table(many_flags: &[ManyFlags]) -> Table {
    let cells = |it: &ManyFlags| {
        vec![
            it.scheme.into(),
            it.n.to_string(),
            it.cloths.to_string(),
            it.cores.to_string(),
            figure(it.ms_per_tick),
            figure(it.ms_min),
            figure(it.ms_per_tick * 1e3 / it.cloths as f64),
            figure(it.over_one_core),
        ]
    };
    Table {
        name: "budget_many_flags".into(),
        title: format!("Flags in the wind, {}", instruction_set()),
        headers: vec![
            "scheme",
            "n",
            "cloths",
            "cores",
            "ms/tick",
            "ms min",
            "µs/cloth",
            "over one core",
        ],
        rows: many_flags.iter().map(cells).collect(),
    }
}

/// Table of the phases of every level.
#[must_use]
pub fn phase_table(phases: &[Phase]) -> Table {
    let cells = |phase: &Phase| {
        vec![
            phase.scheme.into(),
            phase.n.to_string(),
            phase.phase.into(),
            format!("{:.1} %", 100.0 * phase.fraction),
            figure(phase.us),
        ]
    };
    Table {
        name: "budget_phases".into(),
        title: "Phases of the tick of a full batch".into(),
        headers: vec!["scheme", "n", "phase", "of the tick", "µs/tick"],
        rows: phases.iter().map(cells).collect(),
    }
}

/// Table of the times of single kernels.
#[must_use]
pub fn kernel_table(kernels: &Kernels) -> Table {
    Table {
        name: "budget_kernels".into(),
        title: "Kernels, of a full batch of 33 × 33".into(),
        headers: vec!["kernel", "ns per cloth"],
        rows: vec![
            vec!["link of the yarns".into(), figure(kernels.ns_per_constraint)],
            vec![
                "link or hinge of Gauss–Seidel".into(),
                figure(kernels.ns_per_constraint_gauss_seidel),
            ],
            vec!["triangle in the wind".into(), figure(kernels.ns_per_wind_triangle)],
        ],
    }
}

/// Table of the costs of spawning.
#[must_use]
pub fn spawning_table(spawning: &Spawning) -> Table {
    let all = spawning.seconds_to_all.map_or("never".into(), figure);
    let rows = [
        ("budget of a tick, ms", figure(spawning.ms_budget)),
        ("first tick, ms", figure(spawning.ms_first)),
        ("later ticks, ms, 95 %", figure(spawning.ms_p95)),
        ("worst second, ms, 95 %", figure(spawning.ms_p95_worst_second)),
        ("slowest later tick, ms", figure(spawning.ms_worst)),
        ("all are simulated after, s", all),
    ];
    Table {
        name: "budget_spawning".into(),
        title: "200 different flags spawned at once, through the plugin".into(),
        headers: vec!["", ""],
        rows: rows.into_iter().map(|(name, value)| vec![name.into(), value]).collect(),
    }
}

/// Table of the costs of different meshes.
#[must_use]
pub fn different_table(different: &[Different]) -> Table {
    let row = |it: &Different| {
        let all = it.seconds_to_all.map_or("never".into(), figure);
        let [simulated, still] = it.simulated_and_still;
        vec![
            it.meshes.to_string(),
            figure(it.ms_budget),
            it.ms_building.map(figure).join("; "),
            all,
            it.ms.map(figure).join("; "),
            format!("{simulated:.0}; {still:.0}"),
        ]
    };
    Table {
        name: "budget_different".into(),
        title: "Different meshes before a camera that moves, through the plugin".into(),
        headers: vec![
            "meshes",
            "budget, ms",
            "while they are built, ms: 95 %; slowest",
            "all are built after, s",
            "later, ms: median; 95 %",
            "simulated; held still",
        ],
        rows: different.iter().map(row).collect(),
    }
}

/// Table of the costs of a thousand flags.
#[must_use]
pub fn thousand_table(thousand: &Thousand) -> Table {
    let list = |values: &[f64]| {
        let levels = values.iter().zip(LEVELS);
        levels.map(|(flags, n)| format!("{flags:.0} of {n}²")).collect::<Vec<_>>().join(", ")
    };
    let steps = thousand.steps.iter().zip(LEVELS);
    let steps = steps.map(|((substeps, passes), n)| format!("{n}²: {substeps} × {passes}"));
    let sets = ClothSystems::ORDER.iter().zip(&thousand.ms_per_set);
    let sets = sets.map(|(set, ms)| format!("{set:?} {}", figure(*ms)));
    let [median, high] = ["median", "95 %"];
    let rows = [
        (format!("update of the app, ms, {median}"), figure(thousand.ms_median)),
        (format!("update of the app, ms, {high}"), figure(thousand.ms_p95)),
        ("worst second, ms, mean".into(), figure(thousand.ms_worst_second)),
        (format!("worst second, ms, {high}"), figure(thousand.ms_p95_worst_second)),
        (format!("tick of the plugin, ms, {median}"), figure(thousand.ms_tick_median)),
        (format!("tick of the plugin, ms, {high}"), figure(thousand.ms_tick_p95)),
        ("expected of a tick, ms, mean".into(), figure(thousand.ms_expected)),
        (format!("governor, ms, {median}"), figure(thousand.ms_choice_median)),
        (format!("governor, ms, {high}"), figure(thousand.ms_choice_p95)),
        ("sets, ms, median".into(), sets.collect::<Vec<_>>().join(", ")),
        ("simulated, mean".into(), list(&thousand.per_level)),
        ("simulated, least".into(), list(&thousand.per_level_least)),
        ("in view, least".into(), figure(thousand.in_view_least)),
        ("asleep, mean".into(), figure(thousand.asleep)),
        ("held back, mean".into(), figure(thousand.held_back)),
        ("changes a tick".into(), figure(thousand.changes_per_tick)),
        ("substeps × passes".into(), steps.collect::<Vec<_>>().join(", ")),
    ];
    Table {
        name: "budget_thousand".into(),
        title: "1000 flags around a moving camera, through the plugin, one core".into(),
        headers: vec!["", ""],
        rows: rows.into_iter().map(|(name, value)| vec![name, value]).collect(),
    }
}

/// Table of the eight flags of the thesis's figure 6.2 at its finest and coarsest level, beside this
/// project's with default settings, on one core.
#[must_use]
pub fn eight_flags_table(many_flags: &[ManyFlags]) -> Table {
    let ours = |n: u32| {
        let eight = many_flags.iter().find(|it| {
            it.n == n && it.cloths == thesis::FLAGS && it.cores == 1 && it.scheme == "yarns"
        });
        eight.map_or(f64::NAN, |it| it.ms_per_tick)
    };
    let finest = ours(LEVELS[0]);
    let theirs = |level: usize| match level {
        0 => figure(thesis::FINEST_MS),
        _ if level + 1 == LEVELS.len() => figure(thesis::COARSEST_MS),
        _ => "–".into(),
    };
    let row = |(level, &n): (usize, &u32)| {
        let time = ours(n);
        vec![format!("{n} × {n}"), figure(time), figure(finest / time), theirs(level)]
    };
    Table {
        name: "budget_eight_flags".into(),
        title: "Eight flags on one core, and what the thesis has for its finest and coarsest level (its \
                processor and its numbers of vertices are not given)"
            .into(),
        headers: vec!["level", "ms/tick", "times as fast as the finest", "thesis, ms/frame"],
        rows: LEVELS.iter().enumerate().map(row).collect(),
    }
}

/// Table of eight flags at every distance.
#[must_use]
pub fn distance_table(distances: &[AtDistance]) -> Table {
    let cells = |it: &AtDistance| {
        let levels = it.per_level.iter().zip(LEVELS).filter(|(flags, _)| **flags > 0);
        let levels: Vec<String> = levels.map(|(flags, n)| format!("{flags} of {n}²")).collect();
        vec![figure(it.distance_m), levels.join(", "), figure(it.ms_per_tick)]
    };
    Table {
        name: "budget_distance".into(),
        title:
            "Eight flags at a distance, levels by the error in pixels, through the plugin, one core"
                .into(),
        headers: vec!["distance m", "levels", "ms/tick"],
        rows: distances.iter().map(cells).collect(),
    }
}

/// Table of the parts of every level.
#[must_use]
pub fn part_table(parts: &[Part]) -> Table {
    let cells = |it: &Part| {
        let sign = if EXTRAS.contains(&it.part) && it.fraction > 0.0 { "+" } else { "" };
        let fraction = format!("{sign}{:.1} %", 100.0 * it.fraction);
        vec![format!("{n} × {n}", n = it.n), it.part.into(), fraction, figure(it.us)]
    };
    Table {
        name: "budget_parts".into(),
        title: format!(
            "Parts of the tick of a full batch of flags, and what {} add where they are used (internal \
             damping took {:.0} % of the thesis's frame)",
            EXTRAS.join(" and "),
            100.0 * thesis::INTERNAL_DAMPING
        ),
        headers: vec!["level", "part", "of the tick", "µs/tick"],
        rows: parts.iter().map(cells).collect(),
    }
}
