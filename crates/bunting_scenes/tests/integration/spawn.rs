//! Tests that the flags of a scene stay attached to poles and moving vehicles.

use std::path::Path;

use bevy_app::prelude::*;
use bevy_bunting::prelude::*;
use bevy_math::Vec3;
use bevy_time::{TimePlugin, TimeUpdateStrategy};
use bevy_transform::prelude::*;
use bunting_scenes::{Model, Pole, follow_tracks, load, spawn};

/// Ticks of the run: two seconds.
const TICKS: u32 = 128;

/// Greatest distance of an attached vertex from its pole, m.
const ATTACHED: f32 = 1e-4;

fn run() -> App {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/scenes/flags.ron");
    let scene = load(file).unwrap_or_else(|error| panic!("{error}"));
    let mut app = App::new();
    app.add_plugins((TimePlugin, TransformPlugin, ClothPlugins::default()))
        .insert_resource(TimeUpdateStrategy::FixedTimesteps(1))
        .add_systems(FixedUpdate, follow_tracks);
    spawn(&mut app.world_mut().commands(), &scene);
    (0..TICKS).for_each(|_| app.update());
    app
}

fn positions(app: &mut App) -> Vec<Vec<Vec3>> {
    let world = app.world_mut();
    world.query::<&ClothState>().iter(world).map(|state| state.positions().to_vec()).collect()
}

#[test]
fn flags_fly_on_poles_and_vehicles() {
    let mut app = run();
    let world = app.world_mut();
    assert_eq!(world.query::<&Model>().iter(world).count(), 2);
    assert_eq!(world.query::<&Pole>().iter(world).count(), 8);
    let mut flags = world.query::<(&ClothState, &GlobalTransform, &Attachment)>();
    assert_eq!(flags.iter(world).count(), 8);
    for (state, frame, attachment) in flags.iter(world) {
        assert!(state.positions().iter().all(|position| position.is_finite()));
        let foot = world.get::<GlobalTransform>(attachment.target).expect("poles have transforms");
        let hoist = frame.transform_point(state.positions()[0]);
        let expected = foot.transform_point(attachment.offset.translation);
        assert!(hoist.distance(expected) < ATTACHED, "{hoist} {expected}");
    }
}

#[test]
fn two_runs_are_the_same_to_the_bit() {
    assert_eq!(positions(&mut run()), positions(&mut run()));
}
