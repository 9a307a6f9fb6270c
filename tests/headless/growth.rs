//! Tests of cloths, colliders and anchors whose scale changes while they are simulated.

use bevy_app::App;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::{Isometry3d, Quat, Vec3};
use bevy_transform::prelude::*;
use bunting_tests::{FLAG, Seen, app, assert_finite, greatest, run, state};

/// Ticks in which a figure grows to [`SIZE`]: two seconds.
const TICKS: usize = 128;

/// Factor by which figures grow.
const SIZE: f32 = 1.5;

fn failures(app: &App) -> Vec<ClothError> {
    app.world().resource::<Seen<ClothFailed>>().0.iter().map(|failed| failed.error).collect()
}

fn set_scale(app: &mut App, entity: Entity, scale: Vec3) {
    app.world_mut().get_mut::<Transform>(entity).expect("a transform").scale = scale;
}

/// Lets an entity grow from one size to another in two seconds, and calls `each` after each tick.
fn grow(app: &mut App, entity: Entity, [from, to]: [f32; 2], mut each: impl FnMut(&App)) {
    for tick in 1..=TICKS {
        let size = from + (to - from) * tick as f32 / TICKS as f32;
        set_scale(app, entity, Vec3::splat(size));
        run(app, 1);
        each(app);
    }
}

/// Places of all particles in the world, m.
fn places(app: &App, cloth: Entity) -> Vec<Vec3> {
    let frame = *app.world().get::<GlobalTransform>(cloth).expect("a place");
    state(app, cloth).positions().iter().map(|&at| frame.transform_point(at)).collect()
}

/// Greatest strain along warp and weft of a cloth that is drawn out.
fn strain(app: &App, cloth: Entity) -> f32 {
    let material = FabricMaterial::default();
    greatest(state(app, cloth).tensions(&material)) / material.warp_stiffness
}

/// Greatest distance between two cloths' particles relative to their cloths, m.
fn difference(app: &App, one: (Entity, Vec3), other: (Entity, Vec3)) -> f32 {
    let [one, other] = [one, other]
        .map(|(cloth, origin)| places(app, cloth).into_iter().map(move |at| at - origin));
    greatest(one.zip(other).map(|(one, other)| one.distance(other)))
}

/// A figure at the origin with a cape that hangs on its shoulders, whose cloth is a child of it or not.
fn caped(app: &mut App, is_child: bool) -> [Entity; 2] {
    let figure = app.world_mut().spawn(Transform::from_xyz(0.0, 1.0, 0.0)).id();
    let held =
        Attachment::new(figure, ClothEdge::Top).with_offset(Transform::from_xyz(-0.4, 1.5, -0.2));
    let cape = (ClothMesh::grid(17, 17, 0.8, 0.8), held, LodSet::default().pinned_to(0));
    let mut cape = app.world_mut().spawn(cape);
    if is_child {
        cape.insert(ChildOf(figure));
    }
    [figure, cape.id()]
}

#[test]
fn a_figure_that_grows_keeps_its_cape() {
    for is_child in [false, true] {
        let mut app = app();
        let [figure, cape] = caped(&mut app, is_child);
        run(&mut app, 60);
        let fabric = state(&app, cape).fabric().expect("a fabric").clone();
        grow(&mut app, figure, [1.0, SIZE], |app| {
            let figure = *app.world().get::<GlobalTransform>(figure).expect("a place");
            let shoulder = figure.transform_point(Vec3::new(-0.4, 1.5, -0.2));
            let off = places(app, cape)[0].distance(shoulder);
            assert!(off < 1e-5, "{off} m off its shoulder");
            let strain = strain(app, cape);
            assert!(strain < 0.02, "{strain}");
        });
        assert!((state(&app, cape).scale() - SIZE).abs() < 1e-3);
        assert!(std::sync::Arc::ptr_eq(&fabric, state(&app, cape).fabric().expect("a fabric")));
        let corners = [places(&app, cape)[0], places(&app, cape)[16]];
        let width = corners[0].distance(corners[1]);
        assert!((width - 0.8 * SIZE).abs() < 1e-3, "{width} m wide");
        assert_eq!(failures(&app), []);
        assert_finite(&app, cape);
    }
}

/// A cloth with a scale of its own in place at an origin, in wind, with its middle pushed out by a ball of a size.
fn in_wind(app: &mut App, origin: Vec3, scale: f32) -> Entity {
    let held = Attachment::in_place(ClothEdge::Left);
    let place = Transform::from_translation(origin).with_scale(Vec3::splat(scale));
    let lods = LodSet::default().pinned_to(0);
    app.world_mut().spawn((FLAG, held, place, lods, ClothSeed(7), ClothPaused)).id()
}

#[test]
fn cloth_that_has_grown_moves_as_cloth_that_was_made_so_large() {
    for size in [SIZE, 0.5] {
        let mut app = app();
        // Across the cloth, which else buckles as its imperfection wants it, and that is of any size.
        let gravity = Vec3::new(0.0, 0.0, -9.81);
        let steps = vec![StepSettings { passes: 2, ..StepSettings::yarns(6) }.into()];
        app.insert_resource(ClothSettings { gravity, steps, ..ClothSettings::default() });
        app.world_mut().spawn(WindField::steady(Vec3::new(0.0, 0.0, -2.0)));
        let origins = [Vec3::ZERO, 20.0 * Vec3::Z];
        let grown = in_wind(&mut app, origins[0], 1.0);
        let made = in_wind(&mut app, origins[1], size);
        run(&mut app, 5);
        set_scale(&mut app, grown, Vec3::splat(size));
        run(&mut app, 2);
        // Both begin in their sizes.
        for entity in [grown, made] {
            app.world_mut().entity_mut(entity).remove::<ClothPaused>();
        }
        // Later they differ as cloths do whose first differences are rounding.
        for _ in 0..24 {
            run(&mut app, 1);
            let off = difference(&app, (grown, origins[0]), (made, origins[1]));
            assert!(off < 2e-3 * size, "{off} m at a size of {size}");
        }
        let hangs = places(&app, made)[16].z - origins[1].z;
        assert!(hangs < -0.1 * size, "it has moved: {hangs} m");
    }
}

#[test]
fn growth_moves_no_cloth_of_a_figure_that_runs() {
    const SPEED: f32 = 5.0;
    // Of one figure the cloth grows, of the other not.
    let mut ends = [1.0, SIZE].map(|to| {
        let mut app = app();
        app.insert_resource(ClothSettings { air_density: 0.0, ..ClothSettings::default() });
        let [figure, cape] = caped(&mut app, true);
        let mut swing = 0.0_f32;
        for tick in 0..256 {
            let mut pose = app.world_mut().get_mut::<Transform>(figure).expect("a figure");
            pose.translation.x += SPEED / 64.0;
            // At once, when it runs evenly.
            if tick == 200 {
                pose.scale = Vec3::splat(to);
            }
            run(&mut app, 1);
            if tick >= 200 {
                let along = state(&app, cape).velocities().map(|speed| (speed.x - SPEED).abs());
                swing = swing.max(greatest(along));
            }
        }
        swing
    });
    ends.sort_by(f32::total_cmp);
    assert!(ends[1] < ends[0] + 0.15, "{ends:?} m/s along the way");
}

#[test]
fn colliders_are_as_large_as_their_scale() {
    let scaled = |scale: f32| Transform::from_scale(Vec3::splat(scale));
    let shapes = [
        ClothCollider::ball(0.5),
        ClothCollider::cuboid(Vec3::splat(0.5)),
        // Its hull, cut at the top by a face.
        ClothCollider::convex_hull(&cube()).expect("a hull"),
        ClothCollider::triangles(cube().to_vec(), CUBE.to_vec()).expect("a mesh"),
    ];
    for shape in shapes {
        for (own, above) in [(1.0, 1.0), (2.0, 1.0), (1.0, 2.0), (4.0, 0.5)] {
            let mut app = app();
            let parent = app.world_mut().spawn(scaled(above)).id();
            let ball = (shape.clone(), scaled(own), ChildOf(parent));
            let ball = app.world_mut().spawn(ball).id();
            let sheet = (
                ClothMesh::sheet(9, 9, 0.4, 0.4),
                Transform::from_xyz(0.0, 0.5 * own * above + 0.02, 0.0),
                LodSet::default().pinned_to(0),
            );
            let sheet = app.world_mut().spawn(sheet).id();
            run(&mut app, 30);
            let height = |app: &App| places(app, sheet)[4 * 9 + 4].y;
            let top = 0.5 * own * above;
            assert!((height(&app) - top).abs() < 0.01, "{} on {top}", height(&app));
            // And while it grows.
            grow(&mut app, ball, [own, 1.25 * own], |_| {});
            let top = 1.25 * top;
            assert!((height(&app) - top).abs() < 0.01, "{} on {top}, grown", height(&app));
            assert_eq!(failures(&app), []);
        }
    }
}

/// The corners of a cube of a metre around the origin.
fn cube() -> [Vec3; 8] {
    let side = |corner: usize, axis: usize| if corner >> axis & 1 == 1 { 0.5 } else { -0.5 };
    core::array::from_fn(|corner| Vec3::from([0, 1, 2].map(|axis| side(corner, axis))))
}

/// Its triangles, from outside.
const CUBE: [[u32; 3]; 12] = [
    [0, 2, 3],
    [0, 3, 1],
    [4, 5, 7],
    [4, 7, 6],
    [0, 1, 5],
    [0, 5, 4],
    [2, 6, 7],
    [2, 7, 3],
    [0, 4, 6],
    [0, 6, 2],
    [1, 3, 7],
    [1, 7, 5],
];

#[test]
fn cloth_and_collider_that_grow_together_stay_together() {
    let mut app = app();
    let figure = app.world_mut().spawn(Transform::IDENTITY).id();
    // A bust, over whose shoulder a cloth hangs.
    let bust = (ClothCollider::ball(0.3), Transform::from_xyz(0.0, 1.0, 0.0), ChildOf(figure));
    app.world_mut().spawn(bust);
    let held =
        Attachment::new(figure, ClothEdge::Top).with_offset(Transform::from_xyz(-0.4, 1.32, 0.0));
    let cloth = (ClothMesh::grid(17, 17, 0.8, 0.8), held, LodSet::default().pinned_to(0));
    let cloth = app.world_mut().spawn(cloth).id();
    run(&mut app, 128);
    for [from, to] in [[1.0, SIZE], [SIZE, 0.6]] {
        grow(&mut app, figure, [from, to], |app| {
            let size = state(app, cloth).scale();
            let centre = size * Vec3::Y;
            let least = places(app, cloth).iter().map(|at| at.distance(centre)).reduce(f32::min);
            let inside = 0.3 * size - least.expect("particles");
            assert!(inside < 1e-3, "{inside} m inside at a size of {size}");
            assert!(strain(app, cloth) < 0.05, "{}", strain(app, cloth));
        });
    }
    assert_eq!(failures(&app), []);
}

#[test]
fn vertices_on_further_anchors_grow_too() {
    let mut app = app();
    let figure = app.world_mut().spawn(Transform::IDENTITY).id();
    let hands = [-1.0, 1.0].map(|side| {
        let hand = (Transform::from_xyz(side, 1.0, 0.0), ChildOf(figure));
        app.world_mut().spawn(hand).id()
    });
    let second = Anchor::at(hands[1], ClothCorner::TopRight);
    let held = Attachment::at(hands[0], ClothCorner::TopLeft).with_anchor(second);
    let sheet = (ClothMesh::grid(17, 9, 2.0, 1.0), held, LodSet::default().pinned_to(0));
    let sheet = app.world_mut().spawn(sheet).id();
    run(&mut app, 30);
    grow(&mut app, figure, [1.0, SIZE], |app| {
        for (hand, corner) in hands.into_iter().zip([0, 16]) {
            let hand = app.world().get::<GlobalTransform>(hand).expect("a hand").translation();
            let off = places(app, sheet)[corner].distance(hand);
            assert!(off < 1e-4, "{off} m off hand {corner}");
        }
        assert!(strain(app, sheet) < 0.02);
    });
    assert_eq!(failures(&app), []);
}

#[test]
fn changes_that_no_cloth_can_follow_are_said_once() {
    for bad in [Vec3::new(2.0, 1.0, 1.0), Vec3::new(-1.0, 1.0, 1.0), Vec3::ZERO, Vec3::splat(1e4)] {
        let mut app = app();
        let cloth = in_wind(&mut app, Vec3::ZERO, 1.0);
        app.world_mut().entity_mut(cloth).remove::<ClothPaused>();
        run(&mut app, 10);
        set_scale(&mut app, cloth, bad);
        run(&mut app, 10);
        let failures = failures(&app);
        let is_said = |error: &&ClothError| matches!(error, ClothError::ScaleChange { entity, .. } if *entity == cloth);
        assert_eq!(failures.iter().filter(is_said).count(), 1, "{failures:?} of {bad}");
        assert_finite(&app, cloth);
        assert_eq!(state(&app, cloth).scale(), 1.0);
        set_scale(&mut app, cloth, Vec3::splat(2.0));
        run(&mut app, 10);
        assert_eq!(state(&app, cloth).scale(), 2.0);
    }
    // The remedy: made anew, it has any scale.
    let mut app = app();
    let cloth = in_wind(&mut app, Vec3::ZERO, 1.0);
    app.world_mut().entity_mut(cloth).remove::<ClothPaused>();
    run(&mut app, 10);
    set_scale(&mut app, cloth, Vec3::new(2.0, 1.0, 1.0));
    run(&mut app, 1);
    app.world_mut().entity_mut(cloth).insert(FLAG);
    run(&mut app, 10);
    let corners = [places(&app, cloth)[0], places(&app, cloth)[16]];
    assert!((corners[0].distance(corners[1]) - 3.0).abs() < 0.1, "{corners:?}");
}

#[test]
fn what_turns_under_a_scale_does_not_grow() {
    let mut app = app();
    let parent = Transform::from_scale(Vec3::splat(1.7));
    let parent = app.world_mut().spawn(parent).id();
    let middle = app.world_mut().spawn((Transform::from_xyz(0.3, 0.2, 0.1), ChildOf(parent))).id();
    let held = Attachment::in_place(ClothEdge::Left);
    let cloth = app.world_mut().spawn((FLAG, held, Transform::default(), ChildOf(middle))).id();
    for tick in 0..200 {
        for (entity, rate) in [(parent, 0.031), (middle, 0.047), (cloth, 0.013)] {
            let mut pose = app.world_mut().get_mut::<Transform>(entity).expect("a pose");
            let axis = Vec3::new(rate, 0.01, 0.02).normalize();
            pose.rotation = Quat::from_axis_angle(axis, rate * tick as f32);
        }
        run(&mut app, 1);
        assert_eq!(state(&app, cloth).scale(), 1.0);
    }
}

#[test]
fn cloth_that_sleeps_grows_and_rests_again() {
    let mut app = app();
    app.insert_resource(ClothSettings { gravity: Vec3::ZERO, ..ClothSettings::default() });
    let cloth = in_wind(&mut app, Vec3::ZERO, 1.0);
    app.world_mut().entity_mut(cloth).remove::<ClothPaused>();
    run(&mut app, 200);
    assert_eq!(state(&app, cloth).activity(), ClothActivity::AtRest);
    set_scale(&mut app, cloth, Vec3::splat(SIZE));
    run(&mut app, 3);
    assert_eq!(state(&app, cloth).scale(), SIZE);
    let tip = places(&app, cloth)[16];
    assert!(tip.abs_diff_eq(Vec3::X * 1.5 * SIZE, 1e-2), "{tip}");
    run(&mut app, 200);
    assert_eq!(state(&app, cloth).activity(), ClothActivity::AtRest);
}

#[test]
fn cloth_that_has_grown_is_read_and_pushed_in_metres() {
    let mut app = app();
    app.insert_resource(ClothSettings { gravity: Vec3::ZERO, ..ClothSettings::default() });
    let free = (ClothMesh::sheet(9, 9, 1.0, 1.0), LodSet::default().pinned_to(0));
    let cloth = app.world_mut().spawn(free).id();
    run(&mut app, 3);
    set_scale(&mut app, cloth, Vec3::splat(2.0));
    run(&mut app, 3);
    // 2 m wide: of 4 square metres of cloth.
    let hit = app.world_mut().run_system_cached(|mut space: ClothSpatialQuery| {
        let ray = bevy_math::Ray3d::new(Vec3::new(0.9, 3.0, 0.9), bevy_math::Dir3::NEG_Y);
        let far = space.nearest_point(Vec3::new(2.0, 0.0, 0.0), 5.0, |_| true);
        let ball = bevy_bunting::ClothCollider::ball(0.2);
        let at = |x: f32| Isometry3d::from_translation(Vec3::new(x, 0.0, 0.0));
        let meets = [0.9, 1.3].map(|x| space.overlapping(&*ball.shape.0, at(x), |_| true).len());
        (space.cast_ray(ray, 10.0, |_| true), far, meets)
    });
    let (ray, far, meets) = hit.expect("a system");
    let (ray, far) = (ray.expect("a hit"), far.expect("a point"));
    assert!((ray.distance - 3.0).abs() < 1e-3, "{ray:?}");
    assert!(ray.point.abs_diff_eq(Vec3::new(0.9, 0.0, 0.9), 1e-3), "{ray:?}");
    assert!((far.distance - 1.0).abs() < 1e-3 && (far.point.x - 1.0).abs() < 1e-3, "{far:?}");
    assert_eq!(meets, [1, 0]);
    let mass = 4.0 * FabricMaterial::default().area_density;
    app.insert_resource(ClothSettings {
        gravity: Vec3::ZERO,
        air_density: 0.0,
        ..ClothSettings::default()
    });
    let all =
        ClothImpulse { falloff: 0.0, ..ClothImpulse::momentum(Vec3::ZERO, 9.0, mass * Vec3::Y) };
    app.world_mut().trigger(all);
    run(&mut app, 1);
    let speeds: Vec<f32> = state(&app, cloth).velocities().map(|speed| speed.y).collect();
    assert!(speeds.iter().all(|speed| (speed - 1.0).abs() < 0.02), "{speeds:?}");
    let known = app.world_mut().run_system_cached_with(
        |In(cloth): In<Entity>, mut control: ClothControl| {
            control.edit(cloth, |cloth| {
                cloth.add_velocity(40, Vec3::X)?;
                Ok((cloth.velocity(40)?, cloth.to_world(cloth.position(80)?)))
            })
        },
        cloth,
    );
    let (speed, corner) = known.expect("a system").expect("a cloth");
    assert!(speed.abs_diff_eq(Vec3::new(1.0, 1.0, 0.0), 0.03), "{speed}");
    assert!((corner.x - 1.0).abs() < 0.01 && (corner.z - 1.0).abs() < 0.01, "{corner}");
}

#[test]
fn cloth_that_has_grown_is_saved_and_restored() {
    let mut app = app();
    let [figure, cape] = caped(&mut app, true);
    run(&mut app, 20);
    grow(&mut app, figure, [1.0, SIZE], |_| {});
    let saved = app.world().save_cloth(cape).expect("a snapshot");
    run(&mut app, 30);
    let due = places(&app, cape);
    app.world_mut().restore_cloth(cape, &saved).expect("its own snapshot");
    assert_eq!(state(&app, cape).scale(), SIZE);
    run(&mut app, 30);
    assert_eq!(places(&app, cape), due);
}

/// Air of a pressure moves a loose sheet of an area density as fast as one that has not grown.
#[test]
fn air_pushes_cloth_that_has_grown() {
    let mut app = app();
    app.insert_resource(ClothSettings {
        gravity: Vec3::ZERO,
        air_density: 0.0,
        ..ClothSettings::default()
    });
    let [grown, other] = [Vec3::ZERO, 20.0 * Vec3::Z].map(|origin| {
        let place = Transform::from_translation(origin);
        app.world_mut().spawn((ClothMesh::grid(9, 9, 1.0, 1.0), place, LodSet::default())).id()
    });
    run(&mut app, 2);
    set_scale(&mut app, grown, Vec3::splat(2.0));
    for sheet in [grown, other] {
        let air = ClothPressure::Constant { pressure: 0.5 };
        app.world_mut().entity_mut(sheet).insert(air);
    }
    run(&mut app, 32);
    let [of_grown, of_other] = [grown, other].map(|sheet| state(&app, sheet).velocity(40));
    assert!(of_other.length() > 1.5, "{of_other} m/s");
    assert!(of_grown.distance(of_other) < 0.01, "{of_grown} m/s, and {of_other} of the other");
}
