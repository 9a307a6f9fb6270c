//! Flags in gusts that need different numbers of substeps: what their batches cost by need, and with one number for all.

use bevy_app::App;
use bevy_bunting::{
    ClothBatches, ClothEffort, ClothMaterial, ClothSettings, ClothSystems, ClothTimings, LodSet,
    WindField,
};
use bunting_solver::{FabricMaterial, StepSettings};
use glam::Vec3;
use serde::Serialize;
use serde_json::json;

use super::progress;
use crate::{
    game,
    output::{
        Outcome,
        table::{Table, figure},
    },
    timing::Timing,
};

/// Particles along each side of a flag.
const N: u32 = 33;
/// Numbers of flags.
const FLAGS: [usize; 2] = [8, 16];
/// Mean winds, m/s, with gusts of half of it, in which flags need different numbers of substeps.
const WINDS: [f32; 2] = [6.0, 12.0];
const GUSTS: f32 = 0.5;
/// Frequency of gusts, 1/s.
const GUST_RATE: f32 = 0.5;
/// Light polyester.
const MATERIAL: FabricMaterial =
    FabricMaterial { area_density: 0.08, ..FabricMaterial::FLAG_POLYESTER };
/// Distance between two flags, m: each has gusts of its own.
const APART: f32 = 3.0;
/// Ticks before anything is measured.
const WARM_UP: usize = 120;
/// Ticks that are measured, and in a quick run.
const TICKS: usize = 1200;
const QUICK_TICKS: usize = 240;

/// Flags in one wind.
#[derive(Clone, Debug, Serialize)]
struct Row {
    flags: usize,
    /// m/s.
    wind: f32,
    /// Mean number of substeps that a flag needs, and the greatest.
    needed: f64,
    greatest: u32,
    /// Mean number of substeps that a flag takes.
    taken: f64,
    /// Mean number of batches.
    batches: f64,
    /// Mean time of the steps in a tick by need, µs.
    us: f64,
    /// The same without shared batches, µs.
    us_apart: f64,
    /// The same where all flags take the greatest number, µs.
    us_greatest: f64,
    /// The same where all flags take the mean number, between those of the two whole numbers beside it, µs.
    us_mean: f64,
}

/// Flies the same flags in several apps, tick by tick in turn.
#[must_use]
pub fn run(quick: bool) -> Outcome {
    let bar = progress(FLAGS.len() * WINDS.len());
    let ticks = if quick { QUICK_TICKS } else { TICKS };
    let mut rows = Vec::new();
    for (flags, wind) in FLAGS.into_iter().flat_map(|flags| WINDS.map(|wind| (flags, wind))) {
        rows.push(compare(flags, wind, ticks));
        bar.inc(1);
    }
    bar.finish_and_clear();
    Outcome { json: json!({ "rows": rows }), tables: vec![table(&rows)], plots: Vec::new() }
}

fn compare(flags: usize, wind: f32, ticks: usize) -> Row {
    let mut flight = app(flags, wind, ClothSettings::default());
    let mut sums = Sums::default();
    for _ in 0..ticks {
        flight.update();
        sums.add(&mut flight);
    }
    let [needed, taken] = sums.substeps.map(|sum| f64::from(sum) / (ticks * flags) as f64);
    let fixed = |substeps: u32| ClothSettings {
        steps: vec![StepSettings { substeps, ..StepSettings::default() }.into()],
        ..ClothSettings::default()
    };
    let apart = ClothSettings { share_batches: false, ..ClothSettings::default() };
    let whole = [needed.floor(), needed.ceil()].map(|substeps| fixed(substeps as u32));
    let [less, more] = whole;
    let settings = [ClothSettings::default(), apart, fixed(sums.greatest), less, more];
    let mut apps = settings.map(|settings| app(flags, wind, settings));
    let times = game::time_in_turn(&mut apps, ticks, |app| {
        app.world().resource::<ClothTimings>().of(ClothSystems::Step).as_secs_f64() * 1e6
    });
    let [us, us_apart, us_greatest, less, more] = times.map(|times| undisturbed_mean(&times));
    Row {
        flags,
        wind,
        needed,
        greatest: sums.greatest,
        taken,
        batches: f64::from(sums.batches) / ticks as f64,
        us,
        us_apart,
        us_greatest,
        us_mean: less + needed.fract() * (more - less),
    }
}

/// Mean of the times of which other work of the machine disturbed none: longer ones than twice the median count as that.
fn undisturbed_mean(times: &Timing) -> f64 {
    times.clipped_mean(2.0 * times.median())
}

/// Flags in gusts, after the warm-up.
fn app(flags: usize, wind: f32, settings: ClothSettings) -> App {
    let mut app = game::app_in_still_air([StepSettings::default()]);
    app.insert_resource(settings);
    let velocity = wind * Vec3::new(1.0, 0.0, 0.2).normalize();
    app.world_mut().spawn(WindField::steady(velocity).with_gusts(GUSTS * wind, GUST_RATE, 1));
    for flag in 0..flags {
        let at = APART * Vec3::Z * flag as f32;
        let flag = game::spawn_flag(&mut app, N, at, LodSet::default());
        app.world_mut().entity_mut(flag).insert(ClothMaterial(MATERIAL));
    }
    (0..WARM_UP).for_each(|_| app.update());
    app
}

/// Sums over ticks.
#[derive(Default)]
struct Sums {
    /// Of the substeps that flags need, and of those that they take.
    substeps: [u32; 2],
    greatest: u32,
    batches: u32,
}

impl Sums {
    fn add(&mut self, app: &mut App) {
        let world = app.world_mut();
        let mut efforts = world.query::<&ClothEffort>();
        for effort in efforts.iter(world) {
            let needed = effort.needed().substeps;
            self.substeps[0] += needed;
            self.substeps[1] += effort.settings().substeps;
            self.greatest = self.greatest.max(needed);
        }
        self.batches += world.resource::<ClothBatches>().batch_count() as u32;
    }
}

fn table(rows: &[Row]) -> Table {
    let cells = |row: &Row| {
        vec![
            row.flags.to_string(),
            row.wind.to_string(),
            format!("{:.2} ({})", row.needed, row.greatest),
            format!("{:.2}", row.taken),
            format!("{:.2}", row.batches),
            figure(row.us),
            figure(row.us_apart / row.us),
            figure(row.us / row.us_greatest),
            figure(row.us / row.us_mean),
        ]
    };
    Table {
        name: "sharing".into(),
        title: format!(
            "Flags of {N} × {N} in gusts, substeps by need: time of the steps in a tick"
        ),
        headers: vec![
            "flags",
            "wind m/s",
            "needs, mean (most)",
            "takes, mean",
            "batches",
            "µs a tick",
            "without sharing, over it",
            "over all at the most",
            "over all at the mean",
        ],
        rows: rows.iter().map(cells).collect(),
    }
}
