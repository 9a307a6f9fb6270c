//! Code shared by the headless tests: an app with manual time, and access to its cloths.

use std::sync::Mutex;
use std::time::Duration;

use bevy_app::prelude::*;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_time::{TimePlugin, TimeUpdateStrategy};
use bevy_transform::prelude::*;

/// Length of a fixed step, s: Bevy's default.
pub const TICK: f32 = 1.0 / 64.0;

/// The mesh of the flag that most tests use.
pub const FLAG: ClothMesh = ClothMesh::grid(17, 9, 1.5, 1.0);

/// All events of one type, in the order in which they were triggered.
#[derive(Resource, Debug)]
pub struct Seen<E>(pub Vec<E>);

/// An app with cloth and frames as long as a tick: one tick in each update, from the second on.
pub fn app() -> App {
    app_at(Duration::from_micros(15_625))
}

/// An app with cloth and frames of the given length.
pub fn app_at(frame: Duration) -> App {
    let mut app = App::new();
    app.add_plugins((TimePlugin, TransformPlugin, ClothPlugins::default()))
        .insert_resource(TimeUpdateStrategy::ManualDuration(frame));
    collect::<ClothFailed>(&mut app);
    collect::<ClothLevelChanged>(&mut app);
    collect::<ClothTargetLost>(&mut app);
    app
}

/// Collects events in [`Seen`].
fn collect<E>(app: &mut App)
where
    E: for<'a> EntityEvent<Trigger<'a>: Default> + Copy,
{
    app.insert_resource(Seen::<E>(Vec::new()))
        .add_observer(|event: On<E>, mut seen: ResMut<Seen<E>>| seen.0.push(*event.event()));
}

/// Texts of all messages of all tests of this process that were logged from the first call on.
pub fn logged() -> Vec<String> {
    static TEXTS: Mutex<Vec<String>> = Mutex::new(Vec::new());
    struct Collector;
    impl log::Log for Collector {
        fn enabled(&self, _: &log::Metadata) -> bool {
            true
        }
        fn log(&self, record: &log::Record) {
            TEXTS.lock().expect("no panic in a test's log").push(record.args().to_string());
        }
        fn flush(&self) {}
    }
    // Of several tests one is the first.
    if log::set_boxed_logger(Box::new(Collector)).is_ok() {
        log::set_max_level(log::LevelFilter::Warn);
    }
    TEXTS.lock().expect("no panic in a test's log").clone()
}

/// Runs a number of updates.
pub fn run(app: &mut App, updates: usize) {
    (0..updates).for_each(|_| app.update());
}

/// Spawns a flag whose left edge is held by its own transform.
pub fn spawn_flag(app: &mut App, at: Vec3) -> Entity {
    app.world_mut()
        .spawn((FLAG, Attachment::in_place(ClothEdge::Left), Transform::from_translation(at)))
        .id()
}

/// The published state of a cloth.
#[must_use]
pub fn state(app: &App, cloth: Entity) -> &ClothState {
    app.world().get(cloth).expect("a cloth has a state")
}

/// The bits of all positions of a cloth.
#[derive(Clone, PartialEq, Eq)]
pub struct Bits(Vec<[u32; 3]>);

impl core::fmt::Debug for Bits {
    /// Prints only the number of particles and the last of them, since all would be thousands of lines.
    fn fmt(&self, formatter: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let last = self.0.last().map(|bits| bits.map(f32::from_bits));
        write!(formatter, "{} particles, the last at {last:?}", self.0.len())
    }
}

/// The bits of a cloth's positions.
///
/// # Panics
///
/// If the cloth is not simulated: empty lists of positions would be equal.
#[must_use]
pub fn bits(app: &App, cloth: Entity) -> Bits {
    let positions = state(app, cloth).positions();
    assert!(!positions.is_empty(), "the cloth is not simulated");
    Bits(positions.iter().map(|position| position.to_array().map(f32::to_bits)).collect())
}

/// The greatest of values.
///
/// # Panics
///
/// If there are no values, or a value is not a number, which `f32::max` would ignore.
#[must_use]
pub fn greatest(values: impl IntoIterator<Item = f32>) -> f32 {
    let greater = |a: f32, b: f32| {
        assert!(!a.is_nan() && !b.is_nan(), "a value is not a number");
        a.max(b)
    };
    values.into_iter().reduce(greater).expect("there are values")
}

/// The greatest speed of any particle in the last tick, m/s, relative to the cloth's frame.
#[must_use]
pub fn greatest_speed(app: &App, cloth: Entity) -> f32 {
    let state = state(app, cloth);
    let pairs = state.positions().iter().zip(state.previous_positions());
    greatest(pairs.map(|(now, before)| now.distance(*before) / TICK))
}

/// Length over rest length of every link of a cloth.
pub fn stretches(app: &App, cloth: Entity) -> impl Iterator<Item = f32> {
    let state = state(app, cloth);
    let links = state.fabric().expect("the cloth is simulated").links();
    links.iter().map(|link| {
        let [from, to] = link.particles.map(|particle| state.positions()[particle as usize]);
        from.distance(to) / link.rest_length
    })
}

/// Panics unless a cloth has particles and all are finite.
pub fn assert_finite(app: &App, cloth: Entity) {
    let state = state(app, cloth);
    assert!(!state.positions().is_empty(), "the cloth is not simulated");
    assert!(state.positions().iter().all(|position| position.is_finite()));
    assert!(state.normals().iter().all(|normal| normal.is_finite()));
}
