//! What the cloths cost.

use std::time::Duration;

use bevy_app::{App, Plugin};
use bevy_diagnostic::{Diagnostic, DiagnosticPath, Diagnostics, RegisterDiagnostic};
use bevy_ecs::prelude::*;
use bevy_platform::time::Instant;

use crate::lod::LodReport;
use crate::schedule::{ClothSystems, ClothTick};

/// Time that each set of the last [`ClothTick`] took, systems of others in it included.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ClothTimings {
    sets: [Duration; ClothSystems::ORDER.len()],
}

impl ClothTimings {
    /// Time that a set took.
    #[must_use]
    pub fn of(&self, set: ClothSystems) -> Duration {
        self.sets[set as usize]
    }

    /// Time that all sets took.
    #[must_use]
    pub fn total(&self) -> Duration {
        self.sets.iter().sum()
    }
}

/// Number of cloths that are simulated at each level of detail in the last tick, the finest first;
/// those that are asleep are told in the [`LodReport`], paused ones count.
#[derive(Resource, Clone, Debug, Default, PartialEq, Eq)]
pub struct ClothCounts(pub Vec<usize>);

impl ClothCounts {
    /// Counts a cloth at a level.
    pub(crate) fn add(&mut self, level: usize) {
        if self.0.len() <= level {
            self.0.resize(level + 1, 0);
        }
        self.0[level] += 1;
    }
}

/// Measures the sets of [`ClothTick`] for [`ClothTimings`], and tells Bevy's diagnostics.
#[derive(Debug, Default)]
pub struct ClothDiagnosticsPlugin;

impl ClothDiagnosticsPlugin {
    /// Time of each set in ms, in the order of [`ClothSystems::ORDER`].
    pub const SETS: [DiagnosticPath; ClothSystems::ORDER.len()] = [
        DiagnosticPath::const_new("cloth/prepare"),
        DiagnosticPath::const_new("cloth/select_lod"),
        DiagnosticPath::const_new("cloth/drive"),
        DiagnosticPath::const_new("cloth/step"),
        DiagnosticPath::const_new("cloth/normals"),
        DiagnosticPath::const_new("cloth/publish"),
    ];

    /// Time of the whole tick, ms.
    pub const TICK: DiagnosticPath = DiagnosticPath::const_new("cloth/tick");

    /// Number of cloths at each of the finest levels; the last counts all coarser ones, too.
    pub const LEVELS: [DiagnosticPath; 4] = [
        DiagnosticPath::const_new("cloth/level_0"),
        DiagnosticPath::const_new("cloth/level_1"),
        DiagnosticPath::const_new("cloth/level_2"),
        DiagnosticPath::const_new("cloth/level_3"),
    ];

    /// What the tick was expected to cost, ms.
    pub const EXPECTED: DiagnosticPath = DiagnosticPath::const_new("cloth/expected");

    /// Number of cloths that changed their level.
    pub const SWITCHES: DiagnosticPath = DiagnosticPath::const_new("cloth/switches");

    /// Number of cloths that are coarser than they should be, for want of time.
    pub const HELD_BACK: DiagnosticPath = DiagnosticPath::const_new("cloth/held_back");

    /// Number of cloths that are asleep.
    pub const ASLEEP: DiagnosticPath = DiagnosticPath::const_new("cloth/asleep");
}

/// When the set that now runs began.
#[derive(Resource)]
struct SetBegan(Instant);

impl Plugin for ClothDiagnosticsPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<ClothTimings>()
            .insert_resource(SetBegan(Instant::now()))
            .register_diagnostic(Diagnostic::new(Self::TICK).with_suffix("ms"))
            .register_diagnostic(Diagnostic::new(Self::EXPECTED).with_suffix("ms"))
            .register_diagnostic(Diagnostic::new(Self::SWITCHES))
            .register_diagnostic(Diagnostic::new(Self::HELD_BACK))
            .register_diagnostic(Diagnostic::new(Self::ASLEEP));
        for path in Self::SETS {
            app.register_diagnostic(Diagnostic::new(path).with_suffix("ms"));
        }
        for path in Self::LEVELS {
            app.register_diagnostic(Diagnostic::new(path));
        }
        let [prepare, select, drive, step, normals, publish] = ClothSystems::ORDER;
        app.add_systems(
            ClothTick,
            (
                begin.before(prepare),
                end::<0>.after(prepare).before(select),
                end::<1>.after(select).before(drive),
                end::<2>.after(drive).before(step),
                end::<3>.after(step).before(normals),
                end::<4>.after(normals).before(publish),
                (end::<5>, report, report_choice).chain().after(publish),
            ),
        );
    }
}

fn begin(mut began: ResMut<SetBegan>) {
    began.0 = Instant::now();
}

fn end<const SET: usize>(mut began: ResMut<SetBegan>, mut timings: ResMut<ClothTimings>) {
    let now = Instant::now();
    timings.sets[SET] = now - began.0;
    began.0 = now;
}

fn report(mut diagnostics: Diagnostics, timings: Res<ClothTimings>, counts: Res<ClothCounts>) {
    let milliseconds = |time: Duration| time.as_secs_f64() * 1e3;
    for (path, &time) in ClothDiagnosticsPlugin::SETS.iter().zip(&timings.sets) {
        diagnostics.add_measurement(path, || milliseconds(time));
    }
    diagnostics.add_measurement(&ClothDiagnosticsPlugin::TICK, || milliseconds(timings.total()));
    let paths = &ClothDiagnosticsPlugin::LEVELS;
    let (last, finer) = (paths.len() - 1, counts.0.iter().take(paths.len() - 1));
    for (path, &count) in paths.iter().zip(finer) {
        diagnostics.add_measurement(path, || count as f64);
    }
    let coarser: usize = counts.0.iter().skip(last).sum();
    diagnostics.add_measurement(&paths[last], || coarser as f64);
}

fn report_choice(mut diagnostics: Diagnostics, report: Res<LodReport>) {
    type Paths = ClothDiagnosticsPlugin;
    diagnostics.add_measurement(&Paths::EXPECTED, || report.expected.as_secs_f64() * 1e3);
    diagnostics.add_measurement(&Paths::SWITCHES, || report.switches as f64);
    diagnostics.add_measurement(&Paths::HELD_BACK, || report.held_back as f64);
    diagnostics.add_measurement(&Paths::ASLEEP, || report.asleep() as f64);
}
