//! A loop of rollback, as libraries of networked games run it: each frame goes back by some ticks, which are simulated again
//! with the inputs that have arrived since.

use std::time::Duration;

use bevy_app::prelude::*;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::ScheduleLabel;
use bevy_math::{Quat, Vec3};
use bevy_time::{Time, TimePlugin, TimeUpdateStrategy};
use bevy_transform::prelude::*;
use bunting_tests::{Bits, bits};

/// Ticks by which each frame goes back.
const DELAY: u32 = 8;

/// Number of frames.
const FRAMES: u32 = 90;

/// Length of a tick.
const TICK: Duration = Duration::from_nanos(16_666_667);

/// One tick of the game.
#[derive(ScheduleLabel, Clone, Debug, PartialEq, Eq, Hash)]
struct Advance;

/// Where the player steers in the present tick.
#[derive(Resource, Clone, Copy, Default)]
struct Input(f32);

/// What the player does in a tick.
fn steered(tick: u32) -> f32 {
    (0.2 * tick as f32).sin()
}

/// The entity that the player steers.
#[derive(Component)]
struct Player;

fn steer(input: Res<Input>, mut players: Query<&mut Transform, With<Player>>) {
    for mut player in &mut players {
        player.translation.x += 0.05 * input.0;
        player.rotation *= Quat::from_rotation_y(0.03 * input.0);
    }
}

struct Game {
    app: App,
    player: Entity,
    flags: Vec<Entity>,
    /// The player's pose and the state of all cloth after each tick.
    saved: Vec<(Transform, ClothWorldSnapshot)>,
    /// Positions after each tick, as it was simulated last.
    seen: Vec<Vec<Bits>>,
}

impl Game {
    fn new() -> Self {
        let mut app = App::new();
        app.add_plugins((TimePlugin, TransformPlugin, ClothPlugins::new(Advance)))
            .insert_resource(TimeUpdateStrategy::ManualDuration(TICK))
            .init_schedule(Advance)
            .init_resource::<Input>()
            .add_systems(Advance, steer.before(bevy_bunting::run_cloth_tick));
        let world = app.world_mut();
        world.spawn(WindField::steady(Vec3::new(5.0, 0.0, 1.0)).with_gusts(3.0, 0.7, 5));
        let player = world.spawn((Player, Transform::default(), ClothCollider::ball(0.2))).id();
        let flag = ClothMesh::grid(17, 9, 1.5, 1.0);
        let flags = vec![
            world.spawn((flag.clone(), Attachment::new(player, ClothEdge::Left))).id(),
            world.spawn((flag, Attachment::in_place(ClothEdge::Left))).id(),
        ];
        Self { app, player, flags, saved: Vec::new(), seen: Vec::new() }
    }

    /// Simulates a tick, the first of which is 0.
    fn advance(&mut self, tick: u32, steered: f32) {
        let mut time = Time::<()>::default();
        time.advance_to(TICK * tick);
        time.advance_by(TICK);
        let world = self.app.world_mut();
        world.insert_resource(time);
        world.insert_resource(Input(steered));
        world.run_schedule(Advance);
        let player = *self.app.world().get::<Transform>(self.player).expect("a player");
        self.saved.truncate(tick as usize);
        self.saved.push((player, self.app.world().save_cloths().expect("it can be saved")));
        self.seen.truncate(tick as usize);
        self.seen.push(self.flags.iter().map(|&flag| bits(&self.app, flag)).collect());
    }

    /// Goes back to the end of a tick.
    fn go_back(&mut self, tick: u32) {
        let (player, snapshot) = self.saved[tick as usize].clone();
        *self.app.world_mut().get_mut::<Transform>(self.player).expect("a player") = player;
        self.app.world_mut().restore_cloths(&snapshot).expect("it fits");
    }
}

#[test]
fn what_is_simulated_again_with_the_right_inputs_is_what_would_have_been() {
    let mut straight = Game::new();
    for tick in 0..FRAMES {
        straight.app.update();
        straight.advance(tick, steered(tick));
    }
    let mut game = Game::new();
    for frame in 0..FRAMES {
        game.app.update();
        // The inputs of the last ticks are not known before.
        if frame > DELAY {
            game.go_back(frame - DELAY - 1);
            for tick in frame - DELAY..frame {
                let is_known = tick == frame - DELAY;
                game.advance(tick, if is_known { steered(tick) } else { 0.0 });
            }
        }
        let is_known = frame < DELAY;
        game.advance(frame, if is_known { steered(frame) } else { 0.0 });
    }
    for tick in 0..=(FRAMES - DELAY - 1) as usize {
        assert_eq!(game.seen[tick], straight.seen[tick], "tick {tick}");
    }
    assert_ne!(game.seen.last(), straight.seen.last(), "the last inputs were wrong");
}
