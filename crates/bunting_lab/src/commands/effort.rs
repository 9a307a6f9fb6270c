//! Substeps by need beside fixed ones, in winds from light to storm.

use bunting_solver::StepSettings;
use glam::DVec3;
use serde::Serialize;
use serde_json::json;

use crate::{
    flight::{Flag, Flights, Substeps},
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
}

/// Flies all flags.
#[must_use]
pub fn run(quick: bool) -> Outcome {
    let seconds =
        |flag: &Flag| if quick { 3.0 } else { 10.0 * (33.0 / f64::from(flag.n)).min(1.0) };
    let sizes = if quick { &SIZES[..1] } else { &SIZES };
    let flags = sizes.iter().flat_map(|&n| {
        MATERIALS.iter().flat_map(move |&(material, density, stiffness)| {
            WINDS.map(|wind| Flag { n, material, density, stiffness, wind })
        })
    });
    let flags: Vec<Flag> = flags.collect();
    let rows = parallel::map(&flags, |flag| row(flag, seconds(flag)));
    Outcome { json: json!({ "rows": rows }), tables: vec![table(&rows)], plots: Vec::new() }
}

fn row(flag: &Flag, seconds: f64) -> Row {
    let fly = |substeps| flag.fly(substeps, seconds);
    let by_need = fly(Substeps::ByNeed);
    let converged = fly(Substeps::Fixed(CONVERGED));
    let fixed = FIXED.map(|substeps| StepSettings { passes: 2, ..StepSettings::yarns(substeps) });
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
        fixed: fixed.map(|settings| fly(Substeps::Fixed(settings))).into(),
        by_need,
        converged,
    }
}

fn table(rows: &[Row]) -> Table {
    let passed = rows.iter().filter(|row| row.pass).count();
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
            figure(row.by_need.us),
            strain(&row.converged),
            figure(100.0 * row.tip_error),
            figure(100.0 * row.speed_error),
            row.missed.join(", "),
        ];
        cells.extend(row.fixed.iter().map(|it| format!("{}; {}", strain(it), figure(it.us))));
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
