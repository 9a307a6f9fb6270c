//! Scenarios in which users of other products have publicly reported that cloth fails, as far as no other test has them
//! (`docs/notebook/public-reports.md`).

use core::f32::consts::TAU;

use bevy_app::{App, FixedLast, FixedUpdate};
use bevy_bunting::bunting_solver::LinkFamily;
use bevy_bunting::prelude::*;
use bevy_ecs::entity_disabling::Disabled;
use bevy_ecs::prelude::*;
use bevy_math::{Quat, Vec3};
use bevy_time::{Time, Virtual};
use bevy_transform::prelude::*;
use bunting_tests::{FLAG, TICK, app, assert_finite, bits, greatest, greatest_speed, run, state};

/// Updates in a second.
const SECOND: usize = 64;

/// Cloth that comes to rest soon.
const CALM: ClothMaterial =
    ClothMaterial(FabricMaterial { damping: 4.0, ..FabricMaterial::COTTON });

/// Greatest strain of warp and weft.
fn strain(app: &App, cloth: Entity) -> f32 {
    let state = state(app, cloth);
    let links = state.fabric().expect("it is simulated").links().iter().zip(state.strains());
    let is_straight = |family| matches!(family, LinkFamily::Warp | LinkFamily::Weft);
    greatest(links.filter(|(link, _)| is_straight(link.family)).map(|(_, strain)| strain))
}

/// Places of particles in the world, m, of a cloth that is no one's child.
fn places(app: &App, cloth: Entity) -> impl Iterator<Item = Vec3> {
    let at = app.world().get::<Transform>(cloth).expect("a transform");
    state(app, cloth).positions().iter().map(|&position| at.transform_point(position))
}

/// A free sheet, which lies level with its middle above the origin.
fn level_sheet(height: f32) -> impl Bundle {
    (ClothMesh::sheet(17, 17, 0.5, 0.5), CALM, Transform::from_xyz(0.0, height, 0.0))
}

/// Scenes that are left and entered again, pools of characters: the cloth hangs as if it had not been away.
#[test]
fn cloth_that_was_disabled_hangs_on() {
    let mut app = app();
    let pole = app.world_mut().spawn(Transform::from_xyz(0.0, 2.0, 0.0)).id();
    let hung = (FLAG, CALM, Attachment::new(pole, ClothEdge::Left));
    let [away, there] = [(); 2].map(|()| app.world_mut().spawn(hung.clone()).id());
    run(&mut app, SECOND);
    app.world_mut().entity_mut(away).insert(Disabled);
    run(&mut app, SECOND);
    app.world_mut().get_mut::<Transform>(pole).expect("a pole").translation.x = 3.0;
    run(&mut app, SECOND);
    app.world_mut().entity_mut(away).remove::<Disabled>();
    for _ in 0..SECOND {
        app.update();
        assert!(strain(&app, away) < 0.05, "{}", strain(&app, away));
    }
    run(&mut app, 9 * SECOND);
    let off = places(&app, away).zip(places(&app, there)).map(|(away, there)| away.distance(there));
    let off = greatest(off);
    assert!(off < 0.01, "{off} m");
}

/// Shapes side by side, each of which alone is right: cloth neither falls between them nor vanishes.
#[test]
fn cloth_lies_on_two_boxes_as_on_one() {
    let mut app = app();
    let sheet = app.world_mut().spawn(level_sheet(0.1)).id();
    for x in [-0.5, 0.5] {
        let half = ClothCollider::cuboid(Vec3::splat(0.5));
        app.world_mut().spawn((half, Transform::from_xyz(x, -0.5, 0.0)));
    }
    run(&mut app, 5 * SECOND);
    let thickness = CALM.0.thickness;
    for at in places(&app, sheet) {
        assert!((at.y - thickness).abs() < 1e-4, "{at}");
    }
    assert!(strain(&app, sheet) < 1e-3, "{}", strain(&app, sheet));
}

/// Number of ticks so far.
#[derive(Resource, Default)]
struct Ticks(u32);

/// Slow motion, and several ticks in a frame: neither shows in the cloth.
#[test]
fn the_speed_of_time_changes_no_bit() {
    let flown = |speed: f32| {
        let mut app = app();
        app.init_resource::<Ticks>()
            .add_systems(FixedLast, |mut ticks: ResMut<Ticks>| ticks.0 += 1)
            .add_systems(FixedUpdate, |mut poles: Query<&mut Transform, With<LodViewer>>| {
                poles.iter_mut().for_each(|mut pole| pole.translation.x += 2.0 * TICK);
            });
        let world = app.world_mut();
        let pole = world.spawn((LodViewer::default(), Transform::default())).id();
        world.spawn(WindField::steady(4.0 * Vec3::Z).with_gusts(2.0, 0.5, 3));
        let flag = world.spawn((FLAG, Attachment::new(pole, ClothEdge::Left))).id();
        world.resource_mut::<Time<Virtual>>().set_relative_speed(speed);
        while app.world().resource::<Ticks>().0 < 96 {
            app.update();
        }
        assert_eq!(app.world().resource::<Ticks>().0, 96);
        bits(&app, flag)
    };
    let at_once = flown(1.0);
    for speed in [0.125, 4.0] {
        assert_eq!(flown(speed), at_once, "at {speed} times the speed");
    }
}

/// What is thrown goes more than half a metre in a tick, and the board is thin.
#[test]
fn a_sheet_that_is_thrown_at_a_board_stays_above_it() {
    let mut app = app();
    let sheet = app.world_mut().spawn(level_sheet(2.0)).id();
    let board = ClothCollider::cuboid(Vec3::new(2.0, 0.01, 2.0));
    app.world_mut().spawn((board, Transform::from_xyz(0.0, -0.01, 0.0)));
    // Without air, which would stop it after half a metre.
    app.world_mut().resource_mut::<ClothSettings>().air_density = 0.0;
    run(&mut app, 3);
    let push = ClothImpulse::velocity(Vec3::ZERO, f32::INFINITY, -40.0 * Vec3::Y).on(sheet);
    app.world_mut().trigger(push);
    run(&mut app, SECOND);
    let lowest = places(&app, sheet).map(|at| at.y).fold(f32::MAX, f32::min);
    assert!(lowest > -1e-3, "{lowest} m");
}

/// A tube that hangs from its upper rim, m, around the origin.
fn tube(radius: f32, length: f32) -> ClothMesh {
    const AROUND: u32 = 24;
    const DOWN: u32 = 17;
    let at = |down: u32, around: u32| {
        let angle = TAU * around as f32 / AROUND as f32;
        let y = -length * down as f32 / (DOWN - 1) as f32;
        Vec3::new(radius * angle.cos(), y, radius * angle.sin())
    };
    let positions = (0..DOWN).flat_map(|down| (0..AROUND).map(move |around| at(down, around)));
    let cells = (0..DOWN - 1).flat_map(|down| (0..AROUND).map(move |around| (down, around)));
    let indices = cells.flat_map(|(down, around)| {
        let next = (around + 1) % AROUND;
        let [a, b] = [around, next].map(|around| down * AROUND + around);
        let [c, d] = [a + AROUND, b + AROUND];
        [a, b, c, b, d, c]
    });
    ClothMesh::triangles(positions.collect(), indices.collect(), Vec::new())
}

/// A leg in a trouser leg, an arm in a sleeve.
#[test]
fn a_rod_that_turns_in_a_tube_swings_it() {
    let mut app = app();
    let held = Attachment::in_place(AttachedVertices::Border { near: Vec3::ZERO });
    let tube = app.world_mut().spawn((tube(0.1, 0.6), CALM, held, Transform::default())).id();
    let rod = ClothCollider::capsule(0.35, 0.03);
    let rod = app.world_mut().spawn((rod, Transform::from_xyz(0.0, -0.3, 0.0))).id();
    run(&mut app, SECOND);
    let mut worst = 0.0_f32;
    for tick in 0..3 * SECOND {
        let turned = (tick as f32 / SECOND as f32).min(1.0) * 20.0_f32.to_radians();
        let middle = Quat::from_rotation_z(turned) * Vec3::new(0.0, -0.35, 0.0);
        *app.world_mut().get_mut::<Transform>(rod).expect("a rod") =
            Transform::from_translation(middle).with_rotation(Quat::from_rotation_z(turned));
        app.update();
        worst = worst.max(strain(&app, tube));
    }
    assert!(worst < 0.1, "{worst}");
    assert!(greatest_speed(&app, tube) < 0.01, "{} m/s", greatest_speed(&app, tube));
}

/// A door of two leaves that shuts on a curtain but for a gap, m, and opens again. Returns the worst strain, and strain and speed (m/s)
/// three seconds later.
fn shut_door(gap: f32) -> [f32; 3] {
    let mut app = app();
    let place = Transform::from_xyz(-0.5, 1.0, 0.0);
    let held = Attachment::in_place(ClothEdge::Top);
    let curtain = (ClothMesh::grid(33, 33, 1.0, 1.6), CALM, held, place);
    let curtain = app.world_mut().spawn(curtain).id();
    let leaves = [-1.0, 1.0].map(|side: f32| {
        let leaf = ClothCollider::cuboid(Vec3::new(0.3, 0.3, 0.03));
        (side, app.world_mut().spawn((leaf, Transform::from_xyz(0.0, 0.2, 0.4 * side))).id())
    });
    run(&mut app, SECOND);
    let mut worst = 0.0_f32;
    for tick in 0..4 * SECOND {
        // Shut for two seconds.
        let second = tick as f32 / SECOND as f32;
        let open = (1.0 - second).max(second - 3.0).clamp(0.0, 1.0);
        for (side, leaf) in leaves {
            let z = side * (0.03 + 0.5 * gap + 0.37 * open);
            app.world_mut().get_mut::<Transform>(leaf).expect("a leaf").translation.z = z;
        }
        app.update();
        assert_finite(&app, curtain);
        worst = worst.max(strain(&app, curtain));
    }
    run(&mut app, 3 * SECOND);
    [worst, strain(&app, curtain), greatest_speed(&app, curtain)]
}

/// With a gap of a millimetre its edge is pressed through a leaf, and hooked there.
#[test]
fn a_curtain_that_was_caught_by_a_door_hangs_again() {
    for gap in [0.02, 0.005] {
        let [worst, strain, speed] = shut_door(gap);
        assert!(worst < 0.05, "{worst} with {gap} m");
        assert!(strain < 0.01, "{strain} with {gap} m");
        assert!(speed < 0.05, "{speed} m/s with {gap} m");
    }
}

/// A vest under a jacket, whose pins are nearer to one another than the layers keep.
#[test]
fn layers_whose_pins_are_too_near_hang_calmly() {
    let mut app = app();
    let layers = [0.0, 2e-3].map(|z| {
        let held = Attachment::in_place(ClothEdge::Top);
        let apart = ClothCollision { thickness: 5e-3, ..ClothCollision::default() };
        let place = Transform::from_xyz(0.0, 1.0, z);
        app.world_mut().spawn((ClothMesh::grid(17, 25, 0.5, 0.8), CALM, held, apart, place)).id()
    });
    run(&mut app, 5 * SECOND);
    // Below the pins they keep their distance.
    let [vest, jacket] = layers.map(|layer| places(&app, layer).skip(12 * 17).collect::<Vec<_>>());
    let nearest = vest.iter().zip(&jacket).map(|(vest, jacket)| jacket.z - vest.z);
    let nearest = nearest.fold(f32::MAX, f32::min);
    assert!(nearest > 4.5e-3, "{nearest} m");
    for layer in layers {
        assert!(strain(&app, layer) < 0.01, "{}", strain(&app, layer));
        assert!(greatest_speed(&app, layer) < 0.01, "{} m/s", greatest_speed(&app, layer));
    }
}
