//! Winds, colliders and forces of any numbers: cloth stays finite.

use bevy_bunting::prelude::*;
use bevy_bunting::{ClothSurface, Push};
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_transform::prelude::*;
use bunting_tests::{app, run};
use proptest::collection::vec;
use proptest::prelude::*;

use super::beside::assert_all_finite;
use super::for_all;
use super::numbers::{number, pose, vector};

/// What acts on cloth.
#[derive(Clone, Debug)]
enum Actor {
    Wind(WindField),
    Region(WindField, WindRegion),
    Fan(WindFan),
    Blast(WindBlast),
    Wake(WindWake),
    Ball(f32),
    Box(Vec3),
    Capsule([f32; 2]),
}

/// An actor at a place, from which it moves to another one; and the numbers of a collider.
#[derive(Clone, Debug)]
struct Placed {
    actor: Actor,
    from: Transform,
    to: Transform,
    margin: f32,
    friction: f32,
    features: bool,
}

fn wind() -> BoxedStrategy<WindField> {
    (vector(), number(), number(), any::<i32>())
        .prop_map(|(velocity, gust_strength, gust_frequency, seed)| WindField {
            velocity,
            gust_strength,
            gust_frequency,
            seed,
        })
        .boxed()
}

fn region() -> BoxedStrategy<WindRegion> {
    let shape = prop_oneof![
        vector().prop_map(|half_extents| WindShape::Box { half_extents }),
        number().prop_map(|radius| WindShape::Sphere { radius }),
        (number(), number()).prop_map(|(length, radius)| WindShape::Cone { length, radius }),
        (number(), number())
            .prop_map(|(half_height, radius)| WindShape::Capsule { half_height, radius }),
    ];
    (shape, number()).prop_map(|(shape, falloff)| WindRegion { shape, falloff }).boxed()
}

fn actor() -> BoxedStrategy<Actor> {
    prop_oneof![
        wind().prop_map(Actor::Wind),
        (wind(), region()).prop_map(|(wind, region)| Actor::Region(wind, region)),
        [number(), number(), number()].prop_map(|[speed, radius, reach]| Actor::Fan(WindFan {
            speed,
            radius,
            reach
        })),
        [number(), number(), number(), number(), number()].prop_map(
            |[speed, radius, front_speed, duration, age]| Actor::Blast(WindBlast {
                speed,
                radius,
                front_speed,
                duration,
                age
            })
        ),
        number().prop_map(|area| Actor::Wake(WindWake::new(area))),
        number().prop_map(Actor::Ball),
        vector().prop_map(Actor::Box),
        [number(), number()].prop_map(Actor::Capsule),
    ]
    .boxed()
}

fn placed() -> BoxedStrategy<Placed> {
    (actor(), pose(), pose(), number(), number(), any::<bool>())
        .prop_map(|(actor, from, to, margin, friction, features)| Placed {
            actor,
            from,
            to,
            margin,
            friction,
            features,
        })
        .boxed()
}

fn spawn(world: &mut World, placed: &Placed) -> Entity {
    let Placed { margin, friction, features, .. } = *placed;
    let collider =
        |collider: ClothCollider| ClothCollider { margin, friction, features, ..collider };
    let mut entity = world.spawn(placed.from);
    match placed.actor.clone() {
        Actor::Wind(wind) => entity.insert(wind),
        Actor::Region(wind, region) => entity.insert((wind, region)),
        Actor::Fan(fan) => entity.insert(fan),
        Actor::Blast(blast) => entity.insert(blast),
        Actor::Wake(wake) => entity.insert(wake),
        Actor::Ball(radius) => entity.insert(collider(ClothCollider::ball(radius))),
        Actor::Box(half) => entity.insert(collider(ClothCollider::cuboid(half))),
        Actor::Capsule([half, radius]) => {
            entity.insert(collider(ClothCollider::capsule(half, radius)))
        }
    };
    entity.insert(ClothReactions::default()).id()
}

#[test]
fn whatever_acts_on_cloth_leaves_it_finite() {
    let inputs = (
        vec(placed(), 1..4),
        vector(),
        number(),
        number(),
        prop_oneof![vector().prop_map(Push::Velocity), vector().prop_map(Push::Momentum)],
        vector(),
    );
    for_all(64, inputs, |(actors, at, radius, falloff, push, to)| {
        let mut app = app();
        let held = Attachment::in_place(ClothEdge::Left);
        let flag = (ClothMesh::grid(9, 6, 1.0, 0.6), held, ClothSurface::default());
        let flag = app.world_mut().spawn(flag).id();
        app.world_mut().spawn((ClothMesh::grid(5, 5, 0.6, 0.6), WindPerParticle));
        run(&mut app, 3);
        let entities: Vec<_> = actors.iter().map(|it| spawn(app.world_mut(), it)).collect();
        run(&mut app, 4);
        assert_all_finite(&mut app);
        for (entity, actor) in entities.into_iter().zip(&actors) {
            app.world_mut().entity_mut(entity).insert(actor.to);
        }
        app.world_mut().trigger(ClothImpulse { cloth: None, at, radius, falloff, push });
        run(&mut app, 4);
        assert_all_finite(&mut app);
        app.world_mut().trigger(ShiftOrigin { by: to });
        app.world_mut().trigger(TeleportCloth { entity: flag, mode: TeleportMode::Reset });
        run(&mut app, 4);
        assert_all_finite(&mut app);
    });
}
