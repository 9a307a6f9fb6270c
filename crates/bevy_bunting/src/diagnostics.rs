//! Times and counts of cloths, in Bevy's diagnostics.

use std::time::Duration;

use bevy_app::{App, Plugin};
use bevy_diagnostic::{Diagnostic, DiagnosticPath, Diagnostics, RegisterDiagnostic};
use bevy_ecs::prelude::*;

use crate::lod::report::{ClothCounts, LodReport};
use crate::schedule::{ClothSystems, ClothTick};
use crate::timings::{ClothTimings, MeasureSystems, measure_sets};

/// Measures the times of the [`ClothSystems`] for [`ClothTimings`], and adds these times, the counts of
/// cloths by level, and the [`LodReport`] to Bevy's diagnostics.
///
/// ```
/// use bevy_app::prelude::*;
/// use bevy_bunting::ClothDiagnosticsPlugin;
/// use bevy_bunting::prelude::*;
/// use bevy_diagnostic::DiagnosticsStore;
///
/// let mut app = App::new();
/// // The plugin is one of `ClothPlugins`.
/// app.add_plugins((bevy_time::TimePlugin, bevy_transform::TransformPlugin, ClothPlugins::default()));
/// app.update();
/// let diagnostics = app.world().resource::<DiagnosticsStore>();
/// assert!(diagnostics.get(&ClothDiagnosticsPlugin::TICK).is_some());
/// ```
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

    /// Number of cloths at each of the finest levels; the last one includes all coarser levels.
    pub const LEVELS: [DiagnosticPath; 4] = [
        DiagnosticPath::const_new("cloth/level_0"),
        DiagnosticPath::const_new("cloth/level_1"),
        DiagnosticPath::const_new("cloth/level_2"),
        DiagnosticPath::const_new("cloth/level_3"),
    ];

    /// Time of the tick that the governor expected, ms.
    pub const EXPECTED: DiagnosticPath = DiagnosticPath::const_new("cloth/expected");

    /// Number of cloths that changed their level in the tick.
    pub const SWITCHES: DiagnosticPath = DiagnosticPath::const_new("cloth/switches");

    /// Number of cloths that are coarser than their error demands because the budget is spent.
    pub const HELD_BACK: DiagnosticPath = DiagnosticPath::const_new("cloth/held_back");

    /// Number of cloths that take more substeps than their weight needs.
    pub const RAISED: DiagnosticPath = DiagnosticPath::const_new("cloth/raised_effort");

    /// Number of cloths that sleep.
    pub const ASLEEP: DiagnosticPath = DiagnosticPath::const_new("cloth/asleep");
}

impl Plugin for ClothDiagnosticsPlugin {
    fn build(&self, app: &mut App) {
        measure_sets(app);
        app.register_diagnostic(Diagnostic::new(Self::TICK).with_suffix("ms"))
            .register_diagnostic(Diagnostic::new(Self::EXPECTED).with_suffix("ms"))
            .register_diagnostic(Diagnostic::new(Self::SWITCHES))
            .register_diagnostic(Diagnostic::new(Self::HELD_BACK))
            .register_diagnostic(Diagnostic::new(Self::RAISED))
            .register_diagnostic(Diagnostic::new(Self::ASLEEP));
        for path in Self::SETS {
            app.register_diagnostic(Diagnostic::new(path).with_suffix("ms"));
        }
        for path in Self::LEVELS {
            app.register_diagnostic(Diagnostic::new(path));
        }
        app.add_systems(ClothTick, (report_tick, report_choice).chain().after(MeasureSystems));
    }
}

fn report_tick(mut diagnostics: Diagnostics, timings: Res<ClothTimings>, counts: Res<ClothCounts>) {
    let milliseconds = |time: Duration| time.as_secs_f64() * 1e3;
    for (path, set) in ClothDiagnosticsPlugin::SETS.iter().zip(ClothSystems::ORDER) {
        diagnostics.add_measurement(path, || milliseconds(timings.of(set)));
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
    diagnostics.add_measurement(&Paths::RAISED, || report.raised() as f64);
    diagnostics.add_measurement(&Paths::ASLEEP, || report.asleep() as f64);
}
