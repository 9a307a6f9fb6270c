//! Tests that an error names the entity with bad input, and that other cloths are unaffected.

use bevy_app::prelude::*;
use bevy_bunting::LodReport;
use bevy_bunting::prelude::*;
use bevy_math::{Quat, Vec3};
use bevy_transform::prelude::*;
use bunting_tests::{Bits, FLAG, Seen, app, assert_finite, bits, run, spawn_flag, state};

fn errors(app: &App) -> Vec<ClothError> {
    app.world().resource::<Seen<ClothFailed>>().0.iter().map(|failed| failed.error).collect()
}

/// The bits of a flag after a number of updates, in a world with the entities that `spawn` adds.
fn beside(updates: usize, spawn: impl Fn(&mut App)) -> (App, Bits) {
    let mut app = app();
    let flag = spawn_flag(&mut app, Vec3::ZERO);
    run(&mut app, 5);
    spawn(&mut app);
    run(&mut app, updates);
    let bits = bits(&app, flag);
    (app, bits)
}

#[test]
fn a_bad_mesh_is_reported_and_other_cloths_are_simulated() {
    let (_, alone) = beside(30, |_| {});
    let bad: [fn() -> ClothMesh; 4] = [
        || ClothMesh::grid(1, 5, 1.0, 1.0),
        || ClothMesh::grid(5, 5, f32::NAN, 1.0),
        || ClothMesh::triangles(vec![Vec3::ZERO; 3], vec![0, 1, 2], Vec::new()),
        || ClothMesh::triangles(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![0, 1, 9], Vec::new()),
    ];
    for mesh in bad {
        let (app, bits) = beside(30, |app| {
            app.world_mut().spawn(mesh());
        });
        assert_eq!(bits, alone);
        let failed = &app.world().resource::<Seen<ClothFailed>>().0;
        let [ClothFailed { entity, error }] = failed[..] else { panic!("{failed:?}") };
        assert_eq!(app.world().get::<ClothMesh>(entity).map(|_| ()), Some(()));
        assert!(matches!(error, ClothError::Mesh { entity: named, .. } if named == entity));
        assert!(error.to_string().contains(&entity.to_string()), "{error}");
    }
}

#[test]
fn a_corrected_mesh_is_simulated() {
    let mut app = app();
    let cloth = app.world_mut().spawn(ClothMesh::grid(0, 0, 1.0, 1.0)).id();
    run(&mut app, 3);
    assert_eq!(errors(&app).len(), 1);
    app.world_mut().entity_mut(cloth).insert(FLAG);
    run(&mut app, 3);
    assert_eq!(errors(&app).len(), 1);
    assert_finite(&app, cloth);
}

#[test]
fn a_bad_material_is_reported_and_the_last_valid_one_kept() {
    let heavy = ClothMaterial(FabricMaterial { area_density: -1.0, ..FabricMaterial::SILK });
    let mut app = app();
    let cloth = spawn_flag(&mut app, Vec3::ZERO);
    let other = spawn_flag(&mut app, Vec3::ZERO);
    run(&mut app, 5);
    app.world_mut().entity_mut(cloth).insert(heavy);
    run(&mut app, 5);
    assert_eq!(bits(&app, cloth), bits(&app, other));
    assert!(matches!(errors(&app)[..], [ClothError::Material { entity, .. }] if entity == cloth));

    let never_good = app.world_mut().spawn((FLAG, heavy)).id();
    run(&mut app, 5);
    assert!(state(&app, never_good).positions().is_empty());
    app.world_mut().entity_mut(never_good).insert(ClothMaterial::SILK);
    run(&mut app, 5);
    assert_finite(&app, never_good);
    assert_eq!(errors(&app).len(), 2);
}

#[test]
fn bad_levels_and_attachments_are_reported() {
    let mut app = app();
    let missing = app.world_mut().spawn(Transform::default()).id();
    app.world_mut().despawn(missing);
    let world = app.world_mut();
    let unordered = world.spawn((FLAG, LodSet::new([5.0, 4.0]))).id();
    let pinned = world.spawn((FLAG, LodSet::new([5.0]).pinned_to(2))).id();
    let nothing = world
        .spawn((FLAG, Attachment::in_place(AttachedVertices::list_where(&FLAG, |_| false))))
        .id();
    let no_target = world.spawn((FLAG, Attachment::new(missing, ClothEdge::Left))).id();
    run(&mut app, 4);
    for cloth in [unordered, pinned, nothing, no_target] {
        assert_eq!(state(&app, cloth).activity(), ClothActivity::Failed);
    }
    let errors = errors(&app);
    assert_eq!(errors.len(), 4, "{errors:?}");
    let has = |test: &dyn Fn(&ClothError) -> bool| assert!(errors.iter().any(test), "{errors:?}");
    has(&|error| matches!(error, ClothError::Levels { entity } if *entity == unordered));
    has(&|error| matches!(error, ClothError::PinnedLevel { entity, .. } if *entity == pinned));
    has(&|error| matches!(error, ClothError::NoVertices { entity } if *entity == nothing));
    has(&|error| matches!(error, ClothError::MissingTarget { entity, .. } if *entity == no_target));
}

#[test]
fn fewer_levels_than_asked_for_are_a_hint_and_no_failure() {
    let mut app = app();
    let odd = Attachment::in_place(AttachedVertices::List(vec![1]));
    let lods = || LodSet::new([5.0]);
    for _ in 0..20 {
        app.world_mut().spawn((ClothMesh::grid(12, 12, 1.0, 1.0), lods()));
        app.world_mut().spawn((FLAG, lods(), odd.clone()));
    }
    let whole = app.world_mut().spawn((FLAG, lods())).id();
    run(&mut app, 10);
    assert_eq!(errors(&app), []);
    assert_eq!(app.world().resource::<LodReport>().fewer_levels, 40);
    assert_finite(&app, whole);
}

#[test]
fn a_pose_that_is_not_finite_is_reported_once_and_not_followed() {
    let (_, alone) = beside(20, |_| {});
    let mut app = app();
    let flag = spawn_flag(&mut app, Vec3::ZERO);
    run(&mut app, 5);
    let lost = app.world_mut().spawn((FLAG, Attachment::in_place(ClothEdge::Left))).id();
    run(&mut app, 10);
    app.world_mut().entity_mut(lost).insert(Transform::from_rotation(Quat::from_xyzw(
        f32::NAN,
        0.0,
        0.0,
        1.0,
    )));
    run(&mut app, 10);
    assert!(
        matches!(errors(&app)[..], [ClothError::Pose { entity }] if entity == lost),
        "{:?}",
        errors(&app)
    );
    assert_finite(&app, lost);
    assert_eq!(bits(&app, flag), alone);
}

#[test]
fn a_diverged_cloth_is_reset_to_rest() {
    let mut app = app();
    let cloth = spawn_flag(&mut app, Vec3::ZERO);
    run(&mut app, 5);
    // The plugin does not limit gravity; this value overflows.
    app.world_mut().resource_mut::<ClothSettings>().gravity = Vec3::splat(f32::MAX);
    run(&mut app, 1);
    assert!(matches!(errors(&app)[..], [ClothError::Diverged { entity }] if entity == cloth));
    app.world_mut().insert_resource(ClothSettings::default());
    run(&mut app, 20);
    assert_finite(&app, cloth);
    assert_eq!(errors(&app).len(), 1);
}
