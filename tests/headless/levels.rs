//! Levels of detail under a moving viewer.

use bevy_app::prelude::*;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_transform::prelude::*;
use bunting_tests::{Seen, app, assert_finite, run, state};

fn flag(app: &mut App) -> Entity {
    app.world_mut()
        .spawn((
            ClothMesh::grid(33, 33, 1.0, 1.0),
            Attachment::in_place(ClothEdge::Left),
            LodSet::new([10.0, 20.0, 40.0]),
        ))
        .id()
}

#[test]
fn levels_follow_the_viewer_and_stay_finite() {
    let mut app = app();
    let cloth = flag(&mut app);
    app.world_mut().spawn(WindField::steady(Vec3::new(5.0, 0.0, 2.0)));
    run(&mut app, 10);
    assert_eq!(state(&app, cloth).level(), 0, "without a viewer the finest");
    let viewer = app.world_mut().spawn((LodViewer::default(), Transform::default())).id();
    let away = |app: &mut App, distance: f32| {
        app.world_mut().entity_mut(viewer).insert(Transform::from_xyz(0.0, 0.0, distance));
        run(app, 10);
        assert_finite(app, cloth);
        (state(app, cloth).level(), state(app, cloth).positions().len())
    };
    assert_eq!(away(&mut app, 5.0), (0, 33 * 33));
    assert_eq!(away(&mut app, 15.0), (1, 17 * 17));
    assert_eq!(away(&mut app, 30.0), (2, 9 * 9));
    assert_eq!(away(&mut app, 100.0), (3, 5 * 5));
    assert_eq!(away(&mut app, 5.0), (0, 33 * 33));
    let changes: Vec<(usize, usize)> = app
        .world()
        .resource::<Seen<ClothLevelChanged>>()
        .0
        .iter()
        .map(|change| (change.from, change.to))
        .collect();
    assert_eq!(changes, [(0, 1), (1, 2), (2, 3), (3, 0)]);
    // Back at the finest level it is a flag in the wind, not a crumpled one.
    run(&mut app, 60);
    let flag = state(&app, cloth);
    let fabric = flag.fabric().expect("a fabric");
    for link in fabric.links() {
        let [a, b] = link.particles.map(|end| flag.positions()[end as usize]);
        assert!(
            a.distance(b) < 1.2 * link.rest_length,
            "stretched by {}",
            a.distance(b) / link.rest_length
        );
    }
}

#[test]
fn the_nearest_viewer_counts() {
    let mut app = app();
    let cloth = flag(&mut app);
    app.world_mut().spawn((LodViewer::default(), Transform::from_xyz(0.0, 0.0, 100.0)));
    app.world_mut().spawn((LodViewer::default(), Transform::from_xyz(0.0, 0.0, -15.0)));
    run(&mut app, 3);
    assert_eq!(state(&app, cloth).level(), 1);
}

#[test]
fn thrashing_is_harmless() {
    let mut app = app();
    let cloth = flag(&mut app);
    app.world_mut().spawn(WindField::steady(Vec3::new(5.0, 0.0, 2.0)));
    run(&mut app, 2);
    for tick in 0..200 {
        app.world_mut().get_mut::<LodSet>(cloth).expect("levels").pinned = Some(tick % 4);
        run(&mut app, 1);
        assert_finite(&app, cloth);
    }
}

/// The state between the choice of levels and the step: the one that was moved.
#[test]
fn shared_particles_keep_their_place() {
    #[derive(Resource, Default)]
    struct Moved(Vec<Vec3>);
    let mut app = app();
    app.init_resource::<Moved>().add_systems(
        bevy_bunting::ClothTick,
        (|cloths: Query<&ClothState>, mut moved: ResMut<Moved>| {
            moved.0 = cloths.single().expect("one cloth").positions().to_vec();
        })
        .after(ClothSystems::SelectLod)
        .before(ClothSystems::Drive),
    );
    let cloth = flag(&mut app);
    run(&mut app, 30);
    for (from, to) in [(33, 17), (17, 33)] {
        let before = state(&app, cloth).positions().to_vec();
        app.world_mut().get_mut::<LodSet>(cloth).expect("levels").pinned =
            Some(usize::from(to == 17));
        run(&mut app, 1);
        let moved = &app.world().resource::<Moved>().0;
        assert_eq!(moved.len(), to * to);
        for row in 0..17 {
            for column in 0..17 {
                let stride = |count: usize| if count == 33 { 2 } else { 1 };
                let at = |count: usize| stride(count) * (row * count + column);
                assert_eq!(before[at(from)], moved[at(to)], "row {row}, column {column}");
            }
        }
    }
}
