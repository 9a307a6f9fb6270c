//! Tests that anchors of nonsense do not harm other cloths.

use bevy_app::{App, FixedUpdate};
use bevy_bunting::prelude::*;
use bevy_ecs::hierarchy::ChildOf;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_transform::prelude::*;
use bunting_tests::{Bits, Seen, app, assert_finite, bits, run, spawn_flag, state};

/// Ticks of each test.
const TICKS: usize = 90;

const BANNER: ClothMesh = ClothMesh::grid(17, 9, 1.0, 0.5);

/// Bits of a flag after a while beside what `spoil` spawns, and the app.
fn beside(spoil: impl FnOnce(&mut App) -> Option<Entity>) -> (Bits, App, Option<Entity>) {
    let mut app = app();
    app.world_mut().spawn(WindField::steady(Vec3::new(3.0, 0.0, 1.0)).with_gusts(1.0, 0.5, 3));
    let flag = spawn_flag(&mut app, Vec3::Y);
    let spoilt = spoil(&mut app);
    run(&mut app, TICKS);
    (bits(&app, flag), app, spoilt)
}

fn alone() -> Bits {
    beside(|_| None).0
}

fn failures(app: &App) -> Vec<ClothError> {
    app.world().resource::<Seen<ClothFailed>>().0.iter().map(|failed| failed.error).collect()
}

/// Spawns a banner between two entities.
fn banner(app: &mut App, masts: [Entity; 2]) -> Entity {
    let held = Anchor::new(masts[1], ClothEdge::Right);
    let attachment = Attachment::new(masts[0], ClothEdge::Left).with_anchor(held);
    app.world_mut().spawn((BANNER, attachment, AnchorReactions::default())).id()
}

fn masts(app: &mut App) -> [Entity; 2] {
    [0.0, 0.8].map(|x| app.world_mut().spawn(Transform::from_xyz(x, 0.0, 0.0)).id())
}

#[test]
fn bad_numbers_of_anchors_and_grabs_are_reported() {
    let (others, app, cloth) = beside(|app| {
        let masts = masts(app);
        let bad = [
            AnchorHold::Spring { stiffness: f32::NAN, max_force: 1.0 },
            AnchorHold::Spring { stiffness: 1.0, max_force: -1.0 },
            AnchorHold::Rail { points: Vec::new(), ring_mass: 0.1, friction: 0.0 },
            AnchorHold::Rail { points: vec![Vec3::NAN], ring_mass: 0.1, friction: 0.0 },
        ];
        let mut attachment = Attachment::new(masts[0], ClothEdge::Left);
        attachment.anchors = (0..)
            .zip(bad)
            .map(|(at, hold)| {
                Anchor::new(masts[1], AttachedVertices::List(vec![at + 8])).with_hold(hold)
            })
            .collect();
        attachment.anchors.push(Anchor::new(masts[1], ClothCorner::TopRight).breaking_at(f32::NAN));
        let banner = app.world_mut().spawn((BANNER, attachment)).id();
        let bad = ClothGrab::within(banner, f32::NAN);
        app.world_mut().spawn(bad);
        app.world_mut().spawn(ClothGrab::within(masts[0], 1.0));
        Some(banner)
    });
    let cloth = cloth.expect("a cloth");
    let failures = failures(&app);
    for anchor in 0..5 {
        assert!(failures.contains(&ClothError::Anchor { entity: cloth, anchor }), "{failures:?}");
    }
    let of_grabs = failures.iter().filter(|error| matches!(error, ClothError::Grab { .. }));
    assert_eq!(of_grabs.count(), 2, "{failures:?}");
    assert_eq!(failures.len(), 7);
    assert_finite(&app, cloth);
    assert_eq!(others, alone());
}

#[test]
fn a_pose_that_is_not_a_number_leaves_anchors_where_they_were() {
    for bad in [f32::NAN, f32::INFINITY, f32::MAX] {
        let (others, app, cloth) = beside(|app| {
            let masts = masts(app);
            let banner = banner(app, masts);
            let hand = app.world_mut().spawn((Transform::IDENTITY, ClothGrab::within(banner, 0.3)));
            let hand = hand.id();
            run(app, 0);
            app.add_systems(
                FixedUpdate,
                move |mut poses: Query<&mut Transform>, mut tick: Local<u32>| {
                    *tick += 1;
                    if *tick > 30 {
                        for entity in [masts[1], hand] {
                            poses.get_mut(entity).expect("a pose").translation.x = bad;
                        }
                    }
                },
            );
            Some(banner)
        });
        assert_finite(&app, cloth.expect("a cloth"));
        assert_eq!(others, alone(), "{bad}");
    }
}

#[test]
fn a_target_may_be_a_descendant_of_its_cloth() {
    let alone = alone();
    for generations in [1, 3] {
        let (others, app, cloth) = beside(|app| {
            let masts = masts(app);
            let banner = banner(app, masts);
            let world = app.world_mut();
            let mut parent = banner;
            for _ in 1..generations {
                parent = world.spawn((Transform::default(), ChildOf(parent))).id();
            }
            for mast in masts {
                world.entity_mut(mast).insert(ChildOf(parent));
            }
            Some(banner)
        });
        // The cloth follows its own descendant, which follows it: by the descendant's transform in each tick.
        assert_finite(&app, cloth.expect("a cloth"));
        assert_eq!(others, alone, "{generations} generations");
    }
}

#[test]
fn targets_and_hands_may_be_despawned_within_a_tick() {
    for set in
        [ClothSystems::Prepare, ClothSystems::Drive, ClothSystems::Step, ClothSystems::Publish]
    {
        let (others, app, cloth) = beside(|app| {
            let masts = masts(app);
            let banner = banner(app, masts);
            let hand = app.world_mut().spawn((Transform::IDENTITY, ClothGrab::within(banner, 0.3)));
            let hand = hand.id();
            app.add_systems(
                ClothTick,
                (move |mut commands: Commands, mut tick: Local<u32>| {
                    *tick += 1;
                    if *tick == 30 {
                        commands.entity(masts[1]).despawn();
                        commands.entity(hand).despawn();
                    }
                })
                .before(set),
            );
            Some(banner)
        });
        let cloth = cloth.expect("a cloth");
        assert_finite(&app, cloth);
        assert!(app.world().get::<ClothPaused>(cloth).is_some(), "{set:?}");
        assert_eq!(others, alone(), "{set:?}");
    }
}

#[test]
fn a_cloth_may_have_ten_thousand_anchors() {
    let (others, app, cloth) = beside(|app| {
        let masts = masts(app);
        let mut attachment = Attachment::new(masts[0], ClothEdge::Left);
        let of = |at: u32| AttachedVertices::List(vec![at % 153]);
        attachment.anchors = (0..10_000).map(|at| Anchor::new(masts[1], of(at))).collect();
        attachment.anchors.extend(
            (0..10_000)
                .map(|at| Anchor::new(masts[1], of(at)).with_stiffness(1.0).breaking_at(1e3)),
        );
        Some(app.world_mut().spawn((BANNER, attachment)).id())
    });
    assert_finite(&app, cloth.expect("a cloth"));
    assert_eq!(others, alone());
}

#[test]
fn held_cloth_survives_a_wind_of_a_million_metres_a_second() {
    let mut app = app();
    app.world_mut().spawn(WindField::steady(Vec3::new(1e6, 0.0, 1e5)));
    let masts = masts(&mut app);
    let held = |hold: AnchorHold| {
        let anchor = Anchor::new(masts[1], ClothEdge::Right).with_hold(hold);
        Attachment::new(masts[0], ClothEdge::Left).with_anchor(anchor.breaking_at(1e9))
    };
    let points = vec![-3.0 * Vec3::Y, 3.0 * Vec3::Y];
    let holds = [
        AnchorHold::Rigid,
        AnchorHold::Spring { stiffness: 1e6, max_force: f32::INFINITY },
        AnchorHold::Spring { stiffness: 1e-3, max_force: 1.0 },
        AnchorHold::Rail { points, ring_mass: 1e-3, friction: 0.5 },
    ];
    let cloths = holds.map(|hold| app.world_mut().spawn((BANNER, held(hold))).id());
    run(&mut app, TICKS);
    for cloth in cloths {
        assert_finite(&app, cloth);
        assert!(state(&app, cloth).positions().iter().all(|at| at.length() < 1e3));
    }
}
