//! What the headless tests share: an app with manual time, and shortcuts to its cloths.

use std::time::Duration;

use bevy_app::prelude::*;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_time::{TimePlugin, TimeUpdateStrategy};
use bevy_transform::prelude::*;

/// Seconds of a fixed step: Bevy's default.
pub const TICK: f32 = 1.0 / 64.0;

/// The flag that most tests use.
pub const FLAG: ClothMesh = ClothMesh::grid(17, 9, 1.5, 1.0);

/// Events as they came, in order.
#[derive(Resource, Debug)]
pub struct Seen<E>(pub Vec<E>);

/// An app with cloth whose frames last as long as a tick: one tick an update, from the second on.
pub fn app() -> App {
    app_at(Duration::from_micros(15_625))
}

/// An app with cloth whose frames last as given.
pub fn app_at(frame: Duration) -> App {
    let mut app = App::new();
    app.add_plugins((TimePlugin, TransformPlugin, ClothPlugins::default()))
        .insert_resource(TimeUpdateStrategy::ManualDuration(frame));
    see::<ClothFailed>(&mut app);
    see::<ClothLevelChanged>(&mut app);
    see::<ClothTargetLost>(&mut app);
    app
}

fn see<E>(app: &mut App)
where
    E: for<'a> EntityEvent<Trigger<'a>: Default> + Copy,
{
    app.insert_resource(Seen::<E>(Vec::new()))
        .add_observer(|event: On<E>, mut seen: ResMut<Seen<E>>| seen.0.push(*event.event()));
}

/// Runs so many updates.
pub fn run(app: &mut App, updates: usize) {
    (0..updates).for_each(|_| app.update());
}

/// A flag with its left edge on its own transform.
pub fn spawn_flag(app: &mut App, at: Vec3) -> Entity {
    app.world_mut()
        .spawn((FLAG, Attachment::in_place(ClothEdge::Left), Transform::from_translation(at)))
        .id()
}

/// What a cloth publishes.
#[must_use]
pub fn state(app: &App, cloth: Entity) -> &ClothState {
    app.world().get(cloth).expect("a cloth has a state")
}

/// Positions, bit for bit.
#[derive(Clone, PartialEq, Eq)]
pub struct Bits(Vec<[u32; 3]>);

impl core::fmt::Debug for Bits {
    /// Short: a failed comparison would print thousands of numbers.
    fn fmt(&self, formatter: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let last = self.0.last().map(|bits| bits.map(f32::from_bits));
        write!(formatter, "{} particles, the last at {last:?}", self.0.len())
    }
}

/// The bits of a cloth's positions.
#[must_use]
pub fn bits(app: &App, cloth: Entity) -> Bits {
    let positions = state(app, cloth).positions().iter();
    Bits(positions.map(|position| position.to_array().map(f32::to_bits)).collect())
}

/// Velocity of each particle in the last tick, m/s, seen from the cloth's frame.
#[must_use]
pub fn velocities(app: &App, cloth: Entity) -> Vec<Vec3> {
    let state = state(app, cloth);
    let pairs = state.positions().iter().zip(state.previous_positions());
    pairs.map(|(now, before)| (now - before) / TICK).collect()
}

/// The greatest speed of any particle in the last tick, m/s, seen from the cloth's frame.
#[must_use]
pub fn greatest_speed(app: &App, cloth: Entity) -> f32 {
    velocities(app, cloth).iter().map(|velocity| velocity.length()).fold(0.0, f32::max)
}

/// Panics unless a cloth has particles and all are finite.
pub fn assert_finite(app: &App, cloth: Entity) {
    let state = state(app, cloth);
    assert!(!state.positions().is_empty(), "the cloth is not simulated");
    assert!(state.positions().iter().all(|position| position.is_finite()));
    assert!(state.normals().iter().all(|normal| normal.is_finite()));
}
