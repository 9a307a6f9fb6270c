//! Tests of wind where the cloth is: regions, fans, blasts, wakes, shelter.

use bevy_app::prelude::*;
use bevy_bunting::TickWind;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::{Quat, Vec2, Vec3};
use bevy_time::Time;
use bevy_transform::prelude::*;
use bunting_tests::{Bits, Seen, TICK, app, assert_finite, bits, run, spawn_flag, state};

/// The air at a position (m), m/s.
fn air(app: &App, at: Vec3) -> Vec3 {
    app.world().resource::<TickWind>().at(at)
}

/// The bits of a flag at the origin after a number of ticks, in a world with the entities that `spawn` adds.
fn flag_with(ticks: usize, spawn: impl Fn(&mut World)) -> Bits {
    let mut app = app();
    let flag = spawn_flag(&mut app, Vec3::ZERO);
    spawn(app.world_mut());
    run(&mut app, ticks);
    bits(&app, flag)
}

#[test]
fn bounded_winds_blow_where_they_are_and_add_up() {
    let mut app = app();
    let ball = (WindField::steady(Vec3::X * 4.0), WindRegion::ball(3.0, 1.0));
    let ball = app.world_mut().spawn((ball, Transform::from_xyz(10.0, 0.0, 0.0))).id();
    let cuboid = WindRegion::cuboid(Vec3::new(1.0, 1.0, 5.0), 0.0);
    let turned = Transform::from_xyz(10.0, 0.0, 0.0)
        .with_rotation(Quat::from_rotation_y(core::f32::consts::FRAC_PI_2));
    app.world_mut().spawn((WindField::steady(Vec3::Y), cuboid, turned));
    app.world_mut().spawn(WindField::steady(Vec3::Z));
    run(&mut app, 3);
    for (x, expected) in [
        (0.0, Vec3::Z),
        (6.0, Vec3::new(0.0, 1.0, 1.0)),
        (7.5, Vec3::new(2.0, 1.0, 1.0)),
        (9.0, Vec3::new(4.0, 1.0, 1.0)),
    ] {
        let air = air(&app, Vec3::X * x);
        assert!(air.distance(expected) < 1e-5, "{air} at {x} m");
    }
    app.world_mut().get_mut::<Transform>(ball).expect("a place").translation = Vec3::NEG_X * 50.0;
    run(&mut app, 3);
    assert_eq!(air(&app, Vec3::NEG_X * 50.0), Vec3::new(4.0, 0.0, 1.0));
    assert_eq!(air(&app, Vec3::X * 9.0), Vec3::new(0.0, 1.0, 1.0));
}

#[test]
fn a_flag_outside_of_every_region_keeps_its_bits() {
    let calm = flag_with(60, |_| {});
    let region = |distance: f32| {
        move |world: &mut World| {
            let wind = WindField::steady(Vec3::Z * 9.0).with_gusts(2.0, 0.5, 1);
            let at = Transform::from_xyz(distance, 0.0, 0.0);
            world.spawn((wind, WindRegion::ball(3.0, 1.0), at));
        }
    };
    assert_eq!(flag_with(60, region(9.0)), calm);
    assert_ne!(flag_with(60, region(2.0)), calm);
}

#[test]
fn a_region_without_an_end_is_a_global_wind() {
    let wind = WindField::steady(Vec3::new(5.0, 0.0, 3.0)).with_gusts(2.0, 0.5, 1);
    let global = flag_with(60, |world| _ = world.spawn(wind));
    let bounded = flag_with(60, |world| _ = world.spawn((wind, WindRegion::ball(1e9, 0.0))));
    assert_eq!(global, bounded);
}

#[test]
fn a_fan_blows_forwards() {
    let mut app = app();
    let pose = Transform::from_xyz(0.0, 0.0, -5.0).looking_to(Vec3::Z, Vec3::Y);
    let fan = app.world_mut().spawn((WindFan::new(9.0, 0.5), pose)).id();
    let curtain = (ClothMesh::grid(9, 9, 1.0, 1.0), Attachment::in_place(ClothEdge::Top));
    let curtain = app.world_mut().spawn((curtain, Transform::from_xyz(-0.5, 0.5, 0.0))).id();
    run(&mut app, 100);
    assert!(air(&app, Vec3::ZERO).distance(Vec3::Z * 9.0) < 0.01, "{}", air(&app, Vec3::ZERO));
    assert_eq!(air(&app, Vec3::Z * -6.0), Vec3::ZERO);
    let bottom = |app: &App| state(app, curtain).positions()[8 * 9 + 4].z;
    assert!(bottom(&app) > 0.2, "{} m", bottom(&app));
    app.world_mut().get_mut::<Transform>(fan).expect("a pose").look_to(Vec3::NEG_Z, Vec3::Y);
    run(&mut app, 400);
    assert!(bottom(&app).abs() < 0.1, "{} m", bottom(&app));
}

#[test]
fn the_front_of_a_blast_arrives_when_it_should() {
    const DISTANCES: [f32; 3] = [10.0, 30.0, 60.0];
    let flags = |blast: bool, ticks: usize| -> Vec<Bits> {
        let mut app = app();
        let flags = DISTANCES.map(|z| spawn_flag(&mut app, Vec3::new(-0.75, 0.5, z)));
        run(&mut app, 5);
        if blast {
            app.world_mut().spawn(WindBlast { front_speed: 100.0, ..WindBlast::new(30.0, 5.0) });
        }
        run(&mut app, ticks);
        flags.iter().map(|&flag| bits(&app, flag)).collect()
    };
    for (index, distance) in DISTANCES.into_iter().enumerate() {
        // Flags sample the air at their middle, some millimetres from the place.
        let due = (distance / 100.0 / TICK) as usize;
        for (ticks, arrived) in [(due - 1, false), (due + 2, true)] {
            let hit = flags(true, ticks)[index] != flags(false, ticks)[index];
            assert_eq!(hit, arrived, "{distance} m after {ticks} ticks");
        }
    }
}

#[test]
fn a_blast_ends() {
    let mut app = app();
    let blast = app.world_mut().spawn(WindBlast::new(5.0, 1.0)).id();
    run(&mut app, 10);
    assert!(app.world().get::<WindBlast>(blast).is_some());
    assert_ne!(air(&app, Vec3::X * 5.0), Vec3::ZERO);
    run(&mut app, 200);
    assert!(app.world().get::<WindBlast>(blast).is_none());
    assert_eq!(air(&app, Vec3::X * 5.0), Vec3::ZERO);
}

#[test]
fn a_passing_lorry_drags_a_curtain_along() {
    let mut app = app();
    // The curtain hangs across the road's axis, 2 m beside it.
    let pose = Transform::from_xyz(0.0, 0.5, 2.0).with_rotation(Quat::from_rotation_y(-1.57));
    let curtain = (ClothMesh::grid(9, 9, 1.0, 1.0), Attachment::in_place(ClothEdge::Top), pose);
    let curtain = app.world_mut().spawn(curtain).id();
    let lorry = app.world_mut().spawn((WindWake::default(), Transform::from_xyz(-60.0, 0.0, 2.5)));
    let lorry = lorry.id();
    app.add_systems(FixedUpdate, move |mut all: Query<&mut Transform>, time: Res<Time>| {
        all.get_mut(lorry).expect("a lorry").translation.x += 25.0 * time.delta_secs();
    });
    let swing = |app: &App| {
        let at = state(app, curtain).positions()[8 * 9 + 4];
        (pose.rotation * (at - Vec3::new(0.5, -1.0, 0.0))).x
    };
    run(&mut app, 110);
    assert!(swing(&app).abs() < 0.02, "{} m before it comes", swing(&app));
    run(&mut app, 80);
    assert!(swing(&app) > 0.05, "{} m", swing(&app));
}

#[test]
fn shelter_takes_the_wind_away() {
    let strong = WindField::steady(Vec3::new(8.0, 0.0, 4.0));
    let felt = |wind: WindField, influence: Option<f32>| {
        let mut app = app();
        app.world_mut().spawn(wind);
        let flag = spawn_flag(&mut app, Vec3::ZERO);
        if let Some(influence) = influence {
            app.world_mut().entity_mut(flag).insert(WindInfluence(influence));
        }
        run(&mut app, 60);
        bits(&app, flag)
    };
    assert_eq!(felt(strong, Some(1.0)), felt(strong, None));
    let weak = WindField::steady(strong.velocity * 0.5);
    assert_eq!(felt(strong, Some(0.5)), felt(weak, None));
    assert_eq!(felt(strong, Some(0.0)), felt(WindField::default(), None));
    assert_ne!(felt(strong, Some(0.0)), felt(strong, None));
}

#[test]
fn a_sheltered_cloth_feels_no_wind_of_its_ride() {
    let lowest = |influence: f32| {
        let mut app = app();
        let bus = app.world_mut().spawn(Transform::default()).id();
        app.add_systems(FixedUpdate, move |mut all: Query<&mut Transform>, time: Res<Time>| {
            all.get_mut(bus).expect("a bus").translation.z += 20.0 * time.delta_secs();
        });
        let held = Attachment::new(bus, ClothEdge::Top);
        let mesh = ClothMesh::grid(9, 9, 1.0, 1.0);
        let curtain = app.world_mut().spawn((mesh, held, WindInfluence(influence))).id();
        run(&mut app, 64 * 10);
        state(&app, curtain).positions()[8 * 9 + 4]
    };
    assert!(lowest(0.0).z.abs() < 0.01, "{}", lowest(0.0));
    assert!(lowest(1.0).z < -0.7, "{}", lowest(1.0));
}

#[test]
fn a_bad_influence_is_reported_and_counts_as_one() {
    for bad in [f32::NAN, f32::INFINITY, -0.5] {
        let mut app = app();
        app.world_mut().spawn(WindField::steady(Vec3::new(4.0, 0.0, 4.0)));
        let flags = [Vec3::ZERO; 2].map(|at| spawn_flag(&mut app, at));
        app.world_mut().entity_mut(flags[0]).insert(WindInfluence(bad));
        run(&mut app, 30);
        assert_eq!(bits(&app, flags[0]), bits(&app, flags[1]));
        let failed = &app.world().resource::<Seen<ClothFailed>>().0;
        let [ClothFailed { entity, error }] = failed[..] else { panic!("{failed:?}") };
        assert_eq!((entity, error), (flags[0], ClothError::Influence { entity: flags[0] }));
    }
}

#[test]
fn impossible_winds_are_left_out_or_limited_and_change_no_other_cloth() {
    const FAR: Vec3 = Vec3::new(100.0, 0.0, 0.0);
    let alone = flag_with(60, |_| {});
    let winds: [fn(&mut World) -> Entity; 6] = [
        |world| world.spawn(WindField::steady(Vec3::splat(f32::NAN))).id(),
        |world| {
            world.spawn(WindField::steady(Vec3::X * 1e6)).insert(WindRegion::ball(9.0, 1.0)).id()
        },
        |world| world.spawn((WindFan::new(f32::NAN, 1.0), Transform::default())).id(),
        |world| world.spawn(WindBlast::new(1e6, f32::INFINITY)).id(),
        |world| world.spawn(WindBlast { duration: 0.0, ..WindBlast::new(1e6, 1.0) }).id(),
        |world| world.spawn(WindWake::new(f32::NAN)).id(),
    ];
    for (index, wind) in winds.into_iter().enumerate() {
        let mut app = app();
        let flag = spawn_flag(&mut app, Vec3::ZERO);
        let hit = spawn_flag(&mut app, FAR);
        let wind = wind(app.world_mut());
        app.world_mut().entity_mut(wind).insert(Transform::from_translation(FAR));
        run(&mut app, 60);
        assert_eq!(bits(&app, flag), alone, "wind {index}");
        assert_finite(&app, hit);
        assert!(air(&app, FAR).length() < 340.1, "wind {index}");
    }
}

/// A curtain of 2 m that hangs at the origin, at whose right half a wind blows.
fn half_blown(curtain: impl Bundle, mesh: ClothMesh) -> (App, Entity) {
    let mut app = app();
    let held = Attachment::in_place(ClothEdge::Top);
    let at = Transform::from_xyz(-1.0, 1.0, 0.0);
    let curtain = app.world_mut().spawn((mesh, held, at, curtain)).id();
    let region = WindRegion::cuboid(Vec3::new(0.8, 2.0, 3.0), 0.0);
    let right = Transform::from_xyz(1.0, 0.0, 0.0);
    app.world_mut().spawn((WindField::steady(Vec3::Z * 0.6), region, right));
    run(&mut app, 120);
    assert_finite(&app, curtain);
    (app, curtain)
}

/// How far the left and the right lower corners of a curtain of 2 m lean along z, m.
fn leans(app: &App, curtain: Entity) -> [f32; 2] {
    let state = state(app, curtain);
    let rest = state.fabric().expect("a fabric").rest_positions();
    [0.0, 2.0].map(|x| {
        let corner = Vec3::new(x, -2.0, 0.0);
        let corner = rest.iter().position(|at| at.distance(corner) < 1e-3).expect("a corner");
        state.positions()[corner].z
    })
}

/// A square of 2 m of 17 × 17 vertices that are not on a grid.
fn irregular() -> ClothMesh {
    let corners = (0..17 * 17).map(|vertex| [vertex % 17, vertex / 17].map(|at| at as f32 / 8.0));
    let positions = corners.map(|[x, y]| {
        let is_inner = x > 0.0 && x < 2.0 && y > 0.0 && y < 2.0;
        let shift = if is_inner { 0.02 } else { 0.0 };
        Vec3::new(x + shift * (37.0 * y).sin(), -y + shift * (29.0 * x).sin(), 0.0)
    });
    let positions: Vec<Vec3> = positions.collect();
    let uv = positions.iter().map(|at| Vec2::new(at.x, -at.y) / 2.0).collect();
    let cells = (0..16 * 16_u32).map(|cell| cell / 16 * 17 + cell % 16);
    let indices = cells.flat_map(|a| [a, a + 17, a + 1, a + 1, a + 17, a + 18]).collect();
    ClothMesh::triangles(positions, indices, uv)
}

#[test]
fn a_wind_at_half_a_curtain_moves_that_half_only_if_it_feels_each_particle() {
    let (app, curtain) = half_blown((), ClothMesh::grid(17, 17, 2.0, 2.0));
    // The middle is in still air.
    let whole = leans(&app, curtain);
    assert!(whole.iter().all(|lean| lean.abs() < 0.01), "{whole:?} m");
    for mesh in [ClothMesh::grid(17, 17, 2.0, 2.0), irregular()] {
        let (mut app, curtain) = half_blown(WindPerParticle, mesh);
        let [left, right] = leans(&app, curtain);
        assert!(right > 0.1 && left.abs() < 0.4 * right, "{left} and {right} m");
        app.world_mut().entity_mut(curtain).remove::<WindPerParticle>();
        run(&mut app, 1000);
        let settled = leans(&app, curtain);
        assert!(settled.iter().all(|lean| lean.abs() < 0.3 * right), "{settled:?} of {right} m");
    }
}

#[test]
fn one_wind_everywhere_is_the_same_at_each_particle() {
    let flown = |per_particle: bool| {
        flag_with(60, |world| {
            world.spawn(WindField::steady(Vec3::new(5.0, 0.0, 3.0)));
            let flags: Vec<Entity> =
                world.query_filtered::<Entity, With<ClothMesh>>().iter(world).collect();
            for flag in flags {
                if per_particle {
                    world.entity_mut(flag).insert(WindPerParticle);
                }
            }
        })
    };
    assert_eq!(flown(true), flown(false));
}
