//! Substeps by need beside fixed ones, in winds from light to storm.

use bunting_solver::{StepLimits, StepSettings};
use glam::DVec3;
use serde::Serialize;
use serde_json::json;

use crate::{
    flight::{Flag, Flights, Substeps, fly, fly_or_recall, time_of_tick},
    output::{
        Outcome,
        table::{Table, figure},
    },
    parallel,
};

/// Mean winds, m/s.
const WINDS: [f32; 8] = [3.0, 5.0, 8.0, 10.0, 15.0, 20.0, 25.0, 30.0];
/// Names, area densities (kg/m²) and stiffnesses (N/m) of the materials.
const MATERIALS: [(&str, f32, f32); 6] = [
    ("silk", 0.03, 2e3),
    ("stiff silk", 0.03, 2e4),
    ("polyester", 0.113, 2e3),
    ("stiff polyester", 0.113, 2e4),
    ("canvas", 0.5, 2e4),
    ("banner", 1.5, 2e4),
];
/// Particles along each side.
const SIZES: [u32; 3] = [17, 33, 65];
/// Numbers of substeps that are fixed.
const FIXED: [u32; 3] = [2, 4, 8];
/// Settings of a run that counts as converged.
const CONVERGED: StepSettings = StepSettings { passes: 8, ..StepSettings::yarns(16) };
/// Greatest mean strain, over that of the converged run.
const MEAN: f64 = 1.3;
/// Greatest 99.9 % strain: absolute, %, and over that of the converged run.
const P999: [f64; 2] = [3.0, 1.5];
/// Greatest strain of any link, %: in winds up to [`MODERATE`], and in all others.
const GREATEST: [f64; 2] = [8.0, 12.0];
/// m/s.
const MODERATE: f32 = 10.0;
/// Greatest distance of the mean tip from that of the converged run, m.
const TIP: f64 = 0.015;
/// Greatest difference of the root mean square speed from that of the converged run, of one.
const SPEED: f64 = 0.06;

/// A flag's flights, and the bars that they miss.
#[derive(Debug, Serialize)]
struct Row {
    name: String,
    /// Whether the strain by need is within its bars.
    pass: bool,
    /// Names of all bars that are missed.
    missed: Vec<&'static str>,
    /// Distance of the mean tip from that of the converged run, m.
    tip_error: f64,
    /// Difference of the root mean square speed from that of the converged run, of one.
    speed_error: f64,
    by_need: Flights,
    converged: Flights,
    fixed: Vec<Flights>,
    /// Time of a substep of a lone flag, with as many passes as by need, µs.
    us_per_substep: f64,
}

/// Flies all flags. Those of one material and size fly together in fixed substeps.
#[must_use]
pub fn run(quick: bool) -> Outcome {
    let sizes = if quick { &SIZES[..1] } else { &SIZES };
    // The largest flags take longest, and are begun first.
    let groups: Vec<(u32, [Flag; WINDS.len()])> = sizes
        .iter()
        .rev()
        .flat_map(|&n| {
            MATERIALS.map(|(material, density, stiffness)| {
                (n, WINDS.map(|wind| Flag { n, material, density, stiffness, wind }))
            })
        })
        .collect();
    let times: Vec<f64> = groups.iter().map(|(n, _)| microseconds_of_substep(*n)).collect();
    let rows = parallel::map(&groups, |(n, flags)| rows_of(flags, seconds(*n, quick)));
    let rows = rows.into_iter().zip(times).flat_map(|(rows, us_per_substep)| {
        rows.into_iter().map(move |row| Row { us_per_substep, ..row })
    });
    let rows: Vec<Row> = rows.collect();
    Outcome { json: json!({ "rows": rows }), tables: vec![table(&rows)], plots: Vec::new() }
}

/// Length of a flight of a flag of n × n, s.
fn seconds(n: u32, quick: bool) -> f64 {
    if quick { 3.0 } else { 10.0 * (33.0 / f64::from(n)).min(1.0) }
}

fn microseconds_of_substep(n: u32) -> f64 {
    let substeps = FIXED[1];
    time_of_tick(n, fixed(substeps)) / f64::from(substeps)
}

/// A number of substeps with as many passes as by need.
fn fixed(substeps: u32) -> StepSettings {
    StepSettings { passes: StepLimits::default().passes, ..StepSettings::yarns(substeps) }
}

fn rows_of(flags: &[Flag], seconds: f64) -> Vec<Row> {
    let by_need = fly(flags, Substeps::ByNeed, seconds);
    let converged = fly_or_recall(flags, CONVERGED, seconds);
    let fixed = FIXED.map(|substeps| fly_or_recall(flags, fixed(substeps), seconds));
    let rows = flags.iter().zip(by_need).zip(converged).enumerate();
    rows.map(|(index, ((flag, by_need), converged))| {
        let fixed = fixed.iter().map(|flights| flights[index].clone()).collect();
        row(flag, by_need, converged, fixed)
    })
    .collect()
}

fn row(flag: &Flag, by_need: Flights, converged: Flights, fixed: Vec<Flights>) -> Row {
    let tip_error = DVec3::from(by_need.tip).distance(converged.tip.into());
    let speed_error = by_need.speed / converged.speed - 1.0;
    let greatest = GREATEST[usize::from(flag.wind > MODERATE)];
    let strains = [
        ("mean", by_need.mean > MEAN * converged.mean),
        ("99.9 %", by_need.p999 > P999[0].max(P999[1] * converged.p999)),
        ("greatest", by_need.greatest > greatest),
    ];
    let motion = [("tip", tip_error > TIP), ("speed", speed_error.abs() > SPEED)];
    let missed = strains.iter().chain(&motion).filter(|(_, missed)| *missed);
    Row {
        name: format!("{} {} m/s, {}²", flag.material, flag.wind, flag.n),
        pass: strains.iter().all(|(_, missed)| !missed),
        missed: missed.map(|(name, _)| *name).collect(),
        tip_error,
        speed_error,
        by_need,
        converged,
        fixed,
        us_per_substep: 0.0,
    }
}

fn table(rows: &[Row]) -> Table {
    let passed = rows.iter().filter(|row| row.pass).count();
    let us = |row: &Row, flights: &Flights| row.us_per_substep * flights.substeps;
    let strain = |flights: &Flights| {
        format!(
            "{} / {} / {}",
            figure(flights.mean),
            figure(flights.p999),
            figure(flights.greatest)
        )
    };
    let cells = |row: &Row| {
        let mut cells = vec![
            row.name.clone(),
            format!("{:.1} ({})", row.by_need.substeps, row.by_need.most_substeps),
            strain(&row.by_need),
            figure(us(row, &row.by_need)),
            strain(&row.converged),
            figure(100.0 * row.tip_error),
            figure(100.0 * row.speed_error),
            row.missed.join(", "),
        ];
        cells.extend(row.fixed.iter().map(|it| format!("{}; {}", strain(it), figure(us(row, it)))));
        cells
    };
    Table {
        name: "effort".into(),
        title: format!("Substeps by need: strains of {passed} of {} flags hold", rows.len()),
        headers: vec![
            "flag",
            "substeps, mean (most)",
            "strain: mean / 99.9 / greatest, %",
            "µs",
            "converged",
            "tip off, cm",
            "speed off, %",
            "missed",
            "2 × 2; µs",
            "4 × 2; µs",
            "8 × 2; µs",
        ],
        rows: rows.iter().map(cells).collect(),
    }
}
