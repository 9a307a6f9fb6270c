//! Tests of levels of detail with a moving viewer.

use bevy_app::prelude::*;
use bevy_bunting::LodReport;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::{Vec2, Vec3};
use bevy_transform::prelude::*;
use bunting_tests::{Seen, app, assert_finite, greatest, run, state, stretches};

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
    // The cloth is at the finest level again: it must not keep the strain of a bad transfer.
    run(&mut app, 60);
    let stretch = greatest(stretches(&app, cloth));
    assert!(stretch < 1.2, "{stretch}");
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
fn a_level_may_change_in_every_tick() {
    let mut app = app();
    let cloth = flag(&mut app);
    app.world_mut().spawn(WindField::steady(Vec3::new(5.0, 0.0, 2.0)));
    run(&mut app, 2);
    for tick in 0..200 {
        app.world_mut().get_mut::<LodSet>(cloth).expect("levels").pinned = Some(tick % 4);
        run(&mut app, 1);
        assert_finite(&app, cloth);
        assert_eq!(state(&app, cloth).level(), tick % 4);
    }
    let stretch = greatest(stretches(&app, cloth));
    assert!(stretch < 1.1, "{stretch}");
}

/// Compares the state before and after a transfer, before the step.
#[test]
fn particles_of_both_levels_keep_their_positions() {
    #[derive(Resource, Default)]
    struct Transferred(Vec<Vec3>);
    let mut app = app();
    app.init_resource::<Transferred>().add_systems(
        bevy_bunting::ClothTick,
        (|cloths: Query<&ClothState>, mut transferred: ResMut<Transferred>| {
            transferred.0 = cloths.single().expect("one cloth").positions().to_vec();
        })
        .after(ClothSystems::SelectLod)
        .before(ClothSystems::Drive),
    );
    let cloth = flag(&mut app);
    // The change comes before the cloth folds, since folds that the coarser level lacks move elsewhere.
    run(&mut app, 8);
    for (from, to) in [(33, 17), (17, 33)] {
        let before = state(&app, cloth).positions().to_vec();
        app.world_mut().get_mut::<LodSet>(cloth).expect("levels").pinned =
            Some(usize::from(to == 17));
        run(&mut app, 1);
        let after = &app.world().resource::<Transferred>().0;
        assert_eq!(after.len(), to * to);
        for row in 0..17 {
            for column in 0..17 {
                let stride = |count: usize| if count == 33 { 2 } else { 1 };
                let at = |count: usize| stride(count) * (row * count + column);
                // The transfer removes strain, which moves particles a little.
                let moved = before[at(from)].distance(after[at(to)]);
                assert!(moved < 0.02, "row {row}, column {column}: {moved} m");
            }
        }
    }
}

/// A curtain of triangles with a hole.
fn curtain(cells: u32) -> ClothMesh {
    let corners = cells + 1;
    let index = |column: u32, row: u32| row * corners + column;
    let in_hole = |cell: u32| (cells / 3..cells - cells / 3).contains(&cell);
    let mut triangles = Vec::new();
    for row in 0..cells {
        for column in 0..cells {
            if !(in_hole(row) && in_hole(column)) {
                let [a, b] = [index(column, row), index(column + 1, row)];
                let [c, d] = [index(column, row + 1), index(column + 1, row + 1)];
                triangles.extend([a, c, d, a, d, b]);
            }
        }
    }
    let mut used = triangles.clone();
    used.sort_unstable();
    used.dedup();
    let indices = triangles.iter().map(|at| used.binary_search(at).expect("it is used") as u32);
    let uv = |&at: &u32| Vec2::new((at % corners) as f32, (at / corners) as f32) / cells as f32;
    let uvs: Vec<Vec2> = used.iter().map(uv).collect();
    let positions = uvs.iter().map(|uv| Vec3::new(uv.x, -uv.y, 0.0)).collect();
    ClothMesh::triangles(positions, indices.collect(), uvs)
}

#[test]
fn a_curtain_with_a_hole_has_levels() {
    let mut app = app();
    let levels = LodSet::new([5.0, 10.0, 20.0, 40.0, 80.0, 160.0, 320.0]);
    let curtain = (curtain(18), Attachment::in_place(ClothEdge::Top), levels);
    let cloth = app.world_mut().spawn(curtain).id();
    app.world_mut().spawn(WindField::steady(Vec3::new(0.5, 0.0, 1.0)));
    run(&mut app, 60);
    let counts: Vec<usize> = (0..8)
        .map(|level| {
            app.world_mut().get_mut::<LodSet>(cloth).expect("levels").pinned = Some(level);
            run(&mut app, 30);
            assert_finite(&app, cloth);
            state(&app, cloth).positions().len()
        })
        .collect();
    assert!(counts[..4].windows(2).all(|pair| pair[1] < pair[0] * 2 / 3), "{counts:?}");
    // Coarser levels keep the borders and the corners, so the last level cannot be built and repeats the one before.
    assert_eq!(counts[6], counts[7], "{counts:?}");
    assert!(app.world().resource::<Seen<ClothFailed>>().0.is_empty(), "it is simulated");
    assert_eq!(app.world().resource::<LodReport>().fewer_levels, 1);
    app.world_mut().get_mut::<LodSet>(cloth).expect("levels").pinned = Some(0);
    run(&mut app, 60);
    assert!(stretches(&app, cloth).count() > 0);
    for stretch in stretches(&app, cloth) {
        assert!((0.8..1.1).contains(&stretch), "{stretch}");
    }
}
