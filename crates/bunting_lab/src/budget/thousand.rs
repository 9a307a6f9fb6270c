//! A thousand flags around a moving camera, in wind, through the plugin and its governor, on one core.

use std::f32::consts::TAU;

use bevy_app::App;
use bevy_bunting::{
    ClothBudget, ClothCounts, ClothSystems, ClothTimings, LodCosts, LodReport, LodSet, LodViewer,
};
use bevy_ecs::entity::Entity;
use bevy_transform::components::Transform;
use bunting_solver::StepSettings;
use glam::{Quat, Vec3};
use serde::Serialize;

use crate::{
    game,
    scenes::TICK_RATE,
    settings::{LEVELS, steps_of_levels},
    stats,
    timing::Timing,
};

/// Flags in the field.
const FLAGS: usize = 1000;
/// Spacing of the flags on Fermat's spiral, m: the k-th flag stands at this times √k from the middle, one
/// flag on 10 m².
const SPACING: f32 = 1.8;
/// Turn from one flag to the next, as a fraction of a full turn: the golden angle.
const GOLDEN: f32 = 0.381_966;
/// Radius of the camera's path, m; that of the field is 57 m.
const PATH: f32 = 40.0;
/// Height of the camera above the poles' tops, m.
const HEIGHT: f32 = 1.0;
/// Speed of the camera, m/s.
const SPEED: f32 = 10.0;
/// Angle between the camera's view and its direction of flight, inwards, rad.
const INWARDS: f32 = 0.4;
/// Ratios of half the picture's width and half its height to their distance: 60°, 16:9.
const SLOPES: [f32; 2] = [1.026_4, 0.577_35];
/// Time before anything is measured, s: until then flags start to fly and levels settle.
const WARM_UP: usize = 3;
/// Length of the flight, s: once round the path.
const SECONDS: usize = 25;
/// Length of the flight in a quick run, s.
const QUICK_SECONDS: usize = 2;

/// Figures measured in each tick.
#[derive(Default)]
struct Log {
    update: Timing,
    tick: Timing,
    choice: Timing,
    sets: [Timing; ClothSystems::ORDER.len()],
    ticking: Vec<Vec<f64>>,
    in_view: Vec<f64>,
    asleep: Vec<f64>,
    held_back: Vec<f64>,
    switches: Vec<f64>,
    expected: Vec<f64>,
}

/// Times of a thousand flags, and the levels at which they were simulated.
#[derive(Clone, Debug, Serialize)]
pub struct Thousand {
    /// Substeps and passes of each level, the finest first.
    pub steps: Vec<(u32, u32)>,
    /// An update of the whole app, ms: median.
    pub ms_median: f64,
    /// 95th percentile of an update, ms.
    pub ms_p95: f64,
    /// Mean over the slowest second, ms.
    pub ms_worst_second: f64,
    /// 95th percentile in the second in which it is greatest, ms.
    pub ms_p95_worst_second: f64,
    /// A tick of the plugin alone, ms: median.
    pub ms_tick_median: f64,
    /// 95th percentile of a tick, ms.
    pub ms_tick_p95: f64,
    /// The governor alone, part of the tick, ms: median.
    pub ms_choice_median: f64,
    /// 95th percentile of the governor, ms.
    pub ms_choice_p95: f64,
    /// Mean time of a tick that the governor expected, ms.
    pub ms_expected: f64,
    /// Median time of each of the plugin's sets, in their order, ms.
    pub ms_per_set: Vec<f64>,
    /// Mean number of flags that are simulated at each level, the finest first.
    pub per_level: Vec<f64>,
    /// Least number of flags at each level in any tick.
    pub per_level_least: Vec<f64>,
    /// Least number of flags in view; all of them are simulated.
    pub in_view_least: f64,
    /// Mean number of flags that are asleep.
    pub asleep: f64,
    /// Mean number of flags that are coarser than their error demands because the budget is spent.
    pub held_back: f64,
    /// Changes of level a tick.
    pub changes_per_tick: f64,
}

/// A thousand flags in an app, and the camera among them.
pub struct Field {
    app: App,
    camera: Entity,
    places: Vec<Vec3>,
    ticks: usize,
}

impl Field {
    /// Flags that have not begun to fly, with substeps and passes of each level.
    #[must_use]
    pub fn new(steps: &[StepSettings], costs: LodCosts) -> Self {
        let mut app = game::app_in_wind(steps.iter().copied());
        app.world_mut().resource_mut::<ClothBudget>().costs = costs;
        let places: Vec<Vec3> = (0..FLAGS).map(place).collect();
        for &at in &places {
            game::spawn_flag(&mut app, LEVELS[0], at, LodSet::automatic(LEVELS.len()));
        }
        let camera = app.world_mut().spawn((LodViewer::default(), Transform::default())).id();
        Self { app, camera, places, ticks: 0 }
    }

    /// Moves the camera on, and returns its pose.
    fn fly(&mut self) -> Transform {
        let pose = camera_pose(self.ticks);
        self.ticks += 1;
        *self.app.world_mut().get_mut::<Transform>(self.camera).expect("the camera stays") = pose;
        pose
    }

    /// Flies for some ticks.
    pub fn advance(&mut self, ticks: usize) {
        for _ in 0..ticks {
            self.fly();
            self.app.update();
        }
    }

    /// Flies for some ticks, and sums up what was measured in them.
    #[must_use]
    pub fn measure(&mut self, ticks: usize, steps: &[StepSettings]) -> Thousand {
        let mut log = Log::default();
        for _ in 0..ticks {
            let pose = self.fly();
            log.update.time(|| self.app.update());
            log.take(&self.app, &pose, &self.places);
        }
        log.sum_up(steps)
    }
}

/// Flies the camera once round.
#[must_use]
pub fn measure(quick: bool) -> Thousand {
    let steps = steps_of_levels();
    let mut field = Field::new(&steps, LodCosts::Measured);
    let rate = TICK_RATE as usize;
    field.advance(WARM_UP * rate);
    let seconds = if quick { QUICK_SECONDS } else { SECONDS };
    field.measure(seconds * rate, &steps)
}

fn place(flag: usize) -> Vec3 {
    let (angle, radius) = (TAU * GOLDEN * flag as f32, SPACING * (flag as f32).sqrt());
    Vec3::new(radius * angle.cos(), 0.0, radius * angle.sin())
}

/// Pose of the camera: on a circle, looking ahead and inwards.
fn camera_pose(tick: usize) -> Transform {
    let angle = SPEED / PATH * tick as f32 / TICK_RATE as f32;
    let at = Vec3::new(PATH * angle.cos(), HEIGHT, PATH * angle.sin());
    let course = Vec3::new(-angle.sin(), 0.0, angle.cos());
    Transform::from_translation(at).looking_to(Quat::from_rotation_y(-INWARDS) * course, Vec3::Y)
}

/// Whether the middle of a flag is in the picture.
fn is_in_view(camera: &Transform, flag: Vec3) -> bool {
    let middle = flag + Vec3::new(0.5, -0.5, 0.0);
    let seen = camera.rotation.inverse() * (middle - camera.translation);
    seen.z < 0.0 && seen.x.abs() < -SLOPES[0] * seen.z && seen.y.abs() < -SLOPES[1] * seen.z
}

impl Log {
    fn take(&mut self, app: &App, camera: &Transform, places: &[Vec3]) {
        let timings = app.world().resource::<ClothTimings>();
        let report = app.world().resource::<LodReport>();
        let counts = app.world().resource::<ClothCounts>();
        self.tick.push(timings.total().as_secs_f64() * 1e6);
        self.choice.push(report.choice.as_secs_f64() * 1e6);
        for (time, set) in self.sets.iter_mut().zip(ClothSystems::ORDER) {
            time.push(timings.of(set).as_secs_f64() * 1e6);
        }
        let ticking = (0..LEVELS.len()).map(|level| counts.0.get(level).copied().unwrap_or(0));
        self.ticking.push(ticking.map(|count| count as f64).collect());
        let in_view = places.iter().filter(|&&flag| is_in_view(camera, flag)).count();
        self.in_view.push(in_view as f64);
        self.asleep.push(report.asleep() as f64);
        self.held_back.push(report.held_back as f64);
        self.switches.push(report.switches as f64);
        self.expected.push(report.expected.as_secs_f64() * 1e3);
    }

    fn sum_up(self, steps: &[StepSettings]) -> Thousand {
        let rate = TICK_RATE as usize;
        let at_level = |level: usize| self.ticking.iter().map(move |counts| counts[level]);
        let least = |values: &mut dyn Iterator<Item = f64>| values.fold(f64::INFINITY, f64::min);
        let levels = 0..LEVELS.len();
        Thousand {
            steps: steps.iter().map(|step| (step.substeps, step.passes)).collect(),
            ms_median: self.update.median() * 1e-3,
            ms_p95: self.update.percentile(0.95) * 1e-3,
            ms_worst_second: self.update.worst_mean(rate) * 1e-3,
            ms_p95_worst_second: self.update.worst_percentile(rate, 0.95) * 1e-3,
            ms_tick_median: self.tick.median() * 1e-3,
            ms_tick_p95: self.tick.percentile(0.95) * 1e-3,
            ms_choice_median: self.choice.median() * 1e-3,
            ms_choice_p95: self.choice.percentile(0.95) * 1e-3,
            ms_expected: stats::mean(&self.expected),
            ms_per_set: self.sets.iter().map(|time| time.median() * 1e-3).collect(),
            per_level: levels
                .clone()
                .map(|level| stats::mean(&at_level(level).collect::<Vec<_>>()))
                .collect(),
            per_level_least: levels.map(|level| least(&mut at_level(level))).collect(),
            in_view_least: least(&mut self.in_view.iter().copied()),
            asleep: stats::mean(&self.asleep),
            held_back: stats::mean(&self.held_back),
            changes_per_tick: stats::mean(&self.switches),
        }
    }
}
