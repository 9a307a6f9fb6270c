//! What the cloths cost.

use std::time::{Duration, Instant};

use bevy_app::{App, Plugin};
use bevy_diagnostic::{Diagnostic, DiagnosticPath, Diagnostics, RegisterDiagnostic};
use bevy_ecs::prelude::*;

use crate::instance::ClothInstance;
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

/// Number of cloths at each level of detail in the last tick, the finest first; paused ones count.
#[derive(Resource, Clone, Debug, Default, PartialEq, Eq)]
pub struct ClothCounts(pub Vec<usize>);

/// Measures the sets of [`ClothTick`] and counts cloths, for [`ClothTimings`], [`ClothCounts`] and
/// Bevy's diagnostics.
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
}

/// When the set that now runs began.
#[derive(Resource)]
struct SetBegan(Instant);

impl Plugin for ClothDiagnosticsPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<ClothTimings>()
            .init_resource::<ClothCounts>()
            .insert_resource(SetBegan(Instant::now()))
            .register_diagnostic(Diagnostic::new(Self::TICK).with_suffix("ms"));
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
                (end::<5>, count_cloths, report).chain().after(publish),
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

fn count_cloths(cloths: Query<&ClothInstance>, mut counts: ResMut<ClothCounts>) {
    counts.0.fill(0);
    for instance in cloths.iter().filter(|instance| instance.levels.is_some()) {
        if counts.0.len() <= instance.level {
            counts.0.resize(instance.level + 1, 0);
        }
        counts.0[instance.level] += 1;
    }
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
