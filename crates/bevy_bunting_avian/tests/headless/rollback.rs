//! Bodies that feel cloth go back in time: with their own state, the cloth's and their former reaction, and not without.

use avian3d::prelude::*;
use bevy_app::App;
use bevy_bunting::prelude::*;
use bevy_bunting_avian::{FeelsCloth, FormerReaction};
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_transform::prelude::*;
use bunting_tests::{Bits, bits, run};

use crate::{app, sheet};

/// Ticks by which the game goes back, as often as that many have passed.
const BACK: usize = 8;

/// Number of returns.
const RETURNS: usize = 6;

/// Updates before the first return: the ball lies on the sheet then, and swings.
const BEFORE: usize = 48;

/// What a tick reads of a body that touches no other one.
#[derive(Clone, Copy)]
struct SavedBody {
    transform: Transform,
    position: Position,
    rotation: Rotation,
    linear: LinearVelocity,
    angular: AngularVelocity,
    former: FormerReaction,
}

impl SavedBody {
    fn of(app: &App, body: Entity) -> Self {
        let body = app.world().entity(body);
        let (transform, position, rotation, linear, angular, former) = body.components::<(
            &Transform,
            &Position,
            &Rotation,
            &LinearVelocity,
            &AngularVelocity,
            &FormerReaction,
        )>();
        Self {
            transform: *transform,
            position: *position,
            rotation: *rotation,
            linear: *linear,
            angular: *angular,
            former: *former,
        }
    }
}

/// A sheet that is held by two edges, and a ball that falls on it, beside its middle.
fn ball_on_sheet() -> (App, [Entity; 2]) {
    let mut app = app();
    let world = app.world_mut();
    let post = world.spawn(sheet(0.0).1).id();
    let held = Attachment::in_place(ClothEdge::Left);
    let held = held.with_anchor(Anchor::new(post, ClothEdge::Right));
    let cloth = world.spawn((sheet(0.0), held)).id();
    let ball = (RigidBody::Dynamic, SleepingDisabled, Collider::sphere(0.2), Mass(0.2));
    let place = Transform::from_xyz(0.2, 0.4, 0.1);
    let ball = world.spawn((ball, FeelsCloth::default(), place)).id();
    (app, [cloth, ball])
}

/// Where cloth and ball are after some returns. Each time the ball has another velocity before, which must be forgotten.
fn after_returns(returns: usize, restore: impl Fn(&mut SavedBody)) -> (Bits, [u32; 3]) {
    let (mut app, [cloth, ball]) = ball_on_sheet();
    run(&mut app, BEFORE);
    for _ in 0..returns {
        let snapshot = app.world().save_cloths().expect("it can be saved");
        let mut body = SavedBody::of(&app, ball);
        app.world_mut().get_mut::<LinearVelocity>(ball).expect("a body").0 += 2.0 * Vec3::X;
        run(&mut app, BACK);
        restore(&mut body);
        let SavedBody { transform, position, rotation, linear, angular, former } = body;
        let body = (transform, position, rotation, linear, angular, former);
        app.world_mut().entity_mut(ball).insert(body);
        app.world_mut().restore_cloths(&snapshot).expect("it fits");
        run(&mut app, BACK);
    }
    run(&mut app, BACK * (RETURNS - returns));
    let at = app.world().get::<Position>(ball).expect("a body").to_array();
    (bits(&app, cloth), at.map(f32::to_bits))
}

#[test]
fn a_ball_on_a_sheet_goes_back_and_on_as_if_it_had_not() {
    let straight = after_returns(0, |_| {});
    assert_eq!(after_returns(RETURNS, |_| {}), straight);
    let forgotten = after_returns(RETURNS, |body| body.former = FormerReaction::default());
    assert_ne!(forgotten, straight, "the former reaction belongs to the state");
}
