//! Snapshots that cannot be taken or restored: each is an error that says what to do, and changes nothing.

use bevy_app::App;
use bevy_bunting::SnapshotBytesError;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::{Mat4, Vec3};
use bevy_transform::prelude::*;
use bunting_tests::{Bits, app, bits, run, spawn_flag};

/// Where the version is among the bytes of a snapshot.
const VERSION: usize = 8;

/// Where the state begins among the bytes of a snapshot.
const STATE: usize = 16;

fn flying() -> (App, Entity) {
    let mut app = app();
    let flag = spawn_flag(&mut app, Vec3::ZERO);
    run(&mut app, 30);
    (app, flag)
}

/// How a flag goes on.
fn next_ticks(app: &mut App, flag: Entity) -> Vec<Bits> {
    let ticks = (0..5).map(|_| {
        run(app, 1);
        bits(app, flag)
    });
    ticks.collect()
}

#[test]
fn bytes_come_back_as_they_were() {
    let (app, flag) = flying();
    let bytes = app.world().save_cloth(flag).expect("a flag").to_bytes();
    let read = ClothSnapshot::from_bytes(&bytes).expect("they are whole");
    assert_eq!(read.to_bytes(), bytes);
    let world = app.world().save_cloths().expect("a world").to_bytes();
    let read = ClothWorldSnapshot::from_bytes(&world).expect("they are whole");
    assert_eq!(read.to_bytes(), world);
    assert_eq!(read.cloths().collect::<Vec<_>>(), [flag]);
    let ron = ron::to_string(&app.world().save_cloth(flag).expect("a flag")).expect("text");
    let read: ClothSnapshot = ron::from_str(&ron).expect("they are whole");
    assert_eq!(read.to_bytes(), bytes);
}

#[test]
fn bytes_that_are_foreign_damaged_or_of_another_version_are_told() {
    let (app, flag) = flying();
    let bytes = app.world().save_cloth(flag).expect("a flag").to_bytes();
    let error = |bytes: &[u8]| ClothSnapshot::from_bytes(bytes).expect_err("bad bytes");
    for foreign in [&b"PNG"[..], &[], &app.world().save_cloths().expect("a world").to_bytes()] {
        assert!(matches!(error(foreign), SnapshotBytesError::Foreign { .. }), "{}", error(foreign));
    }
    let mut other = bytes.clone();
    other[VERSION] += 1;
    assert!(matches!(error(&other), SnapshotBytesError::Version { found: 5, expected: 4 }));
    for length in [VERSION + 1, STATE, STATE + 1, bytes.len() / 2, bytes.len() - 1] {
        assert_eq!(error(&bytes[..length]), SnapshotBytesError::Damaged, "{length} bytes");
    }
    for at in (STATE..bytes.len()).step_by(997) {
        let mut damaged = bytes.clone();
        damaged[at] ^= 4;
        assert_eq!(error(&damaged), SnapshotBytesError::Damaged, "at {at}");
    }
    let mut longer = bytes.clone();
    longer.push(0);
    assert_eq!(error(&longer), SnapshotBytesError::Damaged);
    let text = ron::to_string(&bytes[1..]).expect("text");
    let told = ron::from_str::<ClothSnapshot>(&text).expect_err("bad bytes").to_string();
    assert!(told.contains("no snapshot of a cloth"), "{told}");
}

#[test]
fn cloths_without_a_state_cannot_be_saved() {
    let mut app = app();
    let flag = spawn_flag(&mut app, Vec3::ZERO);
    let pole = app.world_mut().spawn(Transform::default()).id();
    let error = |app: &App, entity| app.world().save_cloth(entity).expect_err("no state");
    assert_eq!(error(&app, flag), SnapshotError::NotSimulated { entity: flag });
    assert_eq!(error(&app, pole), SnapshotError::NotACloth { entity: pole });
    run(&mut app, 3);
    app.world_mut().get_mut::<ClothMesh>(flag).expect("a cloth").set_changed();
    assert_eq!(error(&app, flag), SnapshotError::Unsettled { entity: flag });
    assert!(app.world().save_cloths().is_err());
    run(&mut app, 1);
    assert!(app.world().save_cloth(flag).is_ok());
    assert!(app.world().save_cloths().is_ok());
    let told = SnapshotError::Unsettled { entity: flag }.to_string();
    assert!(told.contains(&flag.to_string()) && told.contains("after the next tick"), "{told}");
    app.world_mut().despawn(flag);
    assert_eq!(error(&app, flag), SnapshotError::NotACloth { entity: flag });
}

#[test]
fn the_snapshot_of_another_cloth_changes_nothing() {
    let (mut app, flag) = flying();
    let snapshot = app.world().save_cloth(flag).expect("a flag");
    let skin = ClothSkin::new([(flag, Mat4::IDENTITY)])
        .with_vertices((0..17 * 9).map(|_| ([0; 4], [1.0, 0.0, 0.0, 0.0])));
    let held = || Attachment::in_place(ClothEdge::Left);
    let mesh = || ClothMesh::grid(17, 9, 1.5, 1.0);
    let spring = Anchor::new(flag, ClothCorner::BottomRight).with_stiffness(10.0);
    let world = app.world_mut();
    let others = [
        world.spawn((ClothMesh::grid(9, 17, 1.0, 1.5), held())).id(),
        world.spawn((mesh(), Attachment::in_place(ClothEdge::Top))).id(),
        world.spawn((mesh(), held(), LodSet::new([5.0]))).id(),
        world.spawn((mesh(), held(), Transform::from_scale(Vec3::splat(2.0)))).id(),
        world.spawn((mesh(), held().with_anchor(spring))).id(),
    ];
    let skinned = world.spawn((mesh(), held(), skin)).id();
    run(&mut app, 20);
    for &other in &others {
        let error = app.world_mut().restore_cloth(other, &snapshot).expect_err("another cloth");
        assert_eq!(error, SnapshotError::OtherCloth { entity: other });
        assert!(error.to_string().contains(&other.to_string()), "{error}");
    }
    let of_skinned = app.world().save_cloth(skinned).expect("a cloth");
    let error = app.world_mut().restore_cloth(flag, &of_skinned).expect_err("another cloth");
    assert_eq!(error, SnapshotError::OtherCloth { entity: flag });
    let pole = app.world_mut().spawn(Transform::default()).id();
    let error = app.world_mut().restore_cloth(pole, &snapshot).expect_err("a pole");
    assert_eq!(error, SnapshotError::NotACloth { entity: pole });

    let (mut untouched, same) = flying();
    let expected = {
        run(&mut untouched, 20);
        next_ticks(&mut untouched, same)
    };
    assert_eq!(next_ticks(&mut app, flag), expected, "the flag went on");
}

#[test]
fn a_world_in_which_one_cloth_does_not_fit_stays_as_it_is() {
    let (mut app, flag) = flying();
    let other = spawn_flag(&mut app, Vec3::X);
    run(&mut app, 10);
    let snapshot = app.world().save_cloths().expect("two flags");
    run(&mut app, 10);
    let shape = bits(&app, flag);
    app.world_mut().despawn(other);
    let error = app.world_mut().restore_cloths(&snapshot).expect_err("a flag is missing");
    assert_eq!(error, SnapshotError::NotACloth { entity: other });
    assert_eq!(bits(&app, flag), shape);
    // A cloth that is no longer there can be left out.
    use bevy_ecs::entity::{EntityHashMap, MapEntities};
    let mut left_out = snapshot.clone();
    let mut map: EntityHashMap<Entity> = [(other, Entity::PLACEHOLDER)].into_iter().collect();
    left_out.map_entities(&mut map);
    app.world_mut().restore_cloths(&left_out).expect("the other one is there");
    assert_ne!(bits(&app, flag), shape);
}

#[test]
fn a_cloth_that_cannot_be_simulated_is_told() {
    let (mut app, flag) = flying();
    let snapshot = app.world().save_cloth(flag).expect("a flag");
    let bad = ClothMesh::grid(1, 9, 1.5, 1.0);
    let bad = app.world_mut().spawn((bad, Attachment::in_place(ClothEdge::Left))).id();
    let error = app.world_mut().restore_cloth(bad, &snapshot).expect_err("a bad mesh");
    assert!(
        matches!(error, SnapshotError::Cloth(ClothError::Mesh { entity, .. }) if entity == bad)
    );
}
