//! A Bevy app that contains only cloth, set up as in a game.

use std::{
    thread,
    time::{Duration, Instant},
};

use bevy_app::{App, TaskPoolPlugin};
use bevy_bunting::{
    Attachment, ClothEdge, ClothMaterial, ClothMesh, ClothPlugins, ClothSettings, ClothState,
    ClothTimings, LodSet, WindField, bunting_solver::StepSettings,
};
use bevy_ecs::{
    entity::Entity,
    schedule::{Schedules, SingleThreadedExecutor},
};
use bevy_tasks::{ComputeTaskPool, TaskPoolBuilder};
use bevy_time::{Fixed, Time, TimePlugin, TimeUpdateStrategy};
use bevy_transform::{TransformPlugin, components::Transform};
use glam::Vec3;

use crate::{product, scenes::Scene, timing::Timing};

/// Strength of the gusts, m/s.
const GUST: f32 = 1.0;
/// Frequency of gusts, 1/s.
const GUST_RATE: f32 = 0.3;

/// An app on one core in the standard flag's wind, with one tick in each update. Settings are those of each
/// level, the finest first; the last also holds for all coarser levels.
pub fn app_in_wind(settings: impl IntoIterator<Item = StepSettings>) -> App {
    let mut app = app_in_still_air(settings);
    let wind = Vec3::from_array(Scene::flag(2).air.wind.map(|speed| speed as f32));
    app.world_mut().spawn(WindField::steady(wind).with_gusts(GUST, GUST_RATE, 1));
    app
}

/// The same app in still air.
pub fn app_in_still_air(settings: impl IntoIterator<Item = StepSettings>) -> App {
    // With one thread in the pool, the plugin steps batches on the ticking thread.
    ComputeTaskPool::get_or_init(|| TaskPoolBuilder::new().num_threads(1).build());
    let tick = Duration::from_secs_f32(product::TICK);
    let mut app = App::new();
    app.add_plugins((
        TaskPoolPlugin::default(),
        TimePlugin,
        TransformPlugin,
        ClothPlugins::default(),
    ))
    .insert_resource(Time::<Fixed>::from_duration(tick))
    .insert_resource(TimeUpdateStrategy::ManualDuration(tick))
    .insert_resource(ClothSettings {
        steps: settings.into_iter().map(Into::into).collect(),
        ..ClothSettings::default()
    });
    // Another package of the workspace may have turned on Bevy's multi-threaded executor, which moves systems
    // to the pool's thread and so from core to core.
    for (_, schedule) in app.world_mut().resource_mut::<Schedules>().iter_mut() {
        schedule.set_executor(SingleThreadedExecutor::new());
    }
    app
}

/// Spawns the standard flag of n × n on a pole of its own.
pub fn spawn_flag(app: &mut App, n: u32, at: Vec3, lods: LodSet) -> Entity {
    let scene = Scene::flag(n as usize);
    let pole = app.world_mut().spawn(Transform::from_translation(at)).id();
    let flag = (
        ClothMesh::grid(n, n, scene.width as f32, scene.height as f32),
        ClothMaterial(product::material(&scene)),
        Attachment::new(pole, ClothEdge::Left),
        lods,
    );
    app.world_mut().spawn(flag).id()
}

/// Updates an app, and waits until a tick has passed since. Returns the time that the plugin's tick took, s.
pub fn update_in_real_time(app: &mut App) -> f64 {
    let due = Instant::now() + Duration::from_secs_f32(product::TICK);
    app.update();
    thread::sleep(due.saturating_duration_since(Instant::now()));
    app.world().resource::<ClothTimings>().total().as_secs_f64()
}

/// Number of cloths whose fabrics have been built.
pub fn built(app: &mut App) -> usize {
    let world = app.world_mut();
    let mut states = world.query::<&ClothState>();
    states.iter(world).filter(|state| !state.positions().is_empty()).count()
}

/// Updates apps in turn, so that what else the machine does slows all of them. Returns for each app what `time` reads after each
/// of its updates.
pub fn time_in_turn<const APPS: usize>(
    apps: &mut [App; APPS],
    updates: usize,
    time: impl Fn(&App) -> f64,
) -> [Timing; APPS] {
    let mut timings = core::array::from_fn(|_| Timing::default());
    for _ in 0..updates {
        for (app, timing) in apps.iter_mut().zip(&mut timings) {
            app.update();
            timing.push(time(app));
        }
    }
    timings
}
