//! Cloths that are simulated with particles of their own.

use bevy_bunting::prelude::*;
use bevy_math::{Vec2, Vec3};
use bevy_transform::prelude::*;
use bunting_tests::{Seen, app, assert_finite, run, state};

/// Vertices along each side of the sheet of a square metre.
const COUNT: usize = 4;

/// A sheet of a few large triangles.
fn sheet() -> ClothMesh {
    let step = 1.0 / (COUNT - 1) as f32;
    let places = (0..COUNT * COUNT).map(|at| (at % COUNT, at / COUNT));
    let positions = places.clone().map(|(x, y)| step * Vec3::new(x as f32, -(y as f32), 0.0));
    let uv = places.clone().map(|(x, y)| step * Vec2::new(x as f32, y as f32));
    let cells = places.filter(|(x, y)| x + 1 < COUNT && y + 1 < COUNT);
    let indices = cells.flat_map(|(x, y)| {
        let a = (y * COUNT + x) as u32;
        let [b, c, d] = [a + COUNT as u32, a + COUNT as u32 + 1, a + 1];
        [a, b, c, a, c, d]
    });
    ClothMesh::triangles(positions.collect(), indices.collect(), uv.collect())
}

#[test]
fn a_coarse_mesh_is_simulated_in_cells_of_its_own() {
    let mut app = app();
    let held = || (sheet(), Attachment::in_place(ClothEdge::Top), Transform::default());
    let usual = app.world_mut().spawn(held()).id();
    let fine = app.world_mut().spawn((held(), ClothResolution::CellSize(0.05))).id();
    run(&mut app, 200);
    assert!(app.world().resource::<Seen<ClothFailed>>().0.is_empty());
    let count = state(&app, usual).positions().len();
    assert!((800..1200).contains(&count), "{count}: about a thousand");
    let cloth = state(&app, fine);
    assert!(cloth.positions().len() > 300, "{}", cloth.positions().len());
    for vertex in 0..COUNT as u32 {
        // What is held stays where it is.
        let at = cloth.vertex_position(vertex).expect("a vertex");
        assert!(at.distance(Vec3::X * vertex as f32 / (COUNT - 1) as f32) < 1e-6, "{at}");
        let particle = cloth.particle_of_vertex(vertex).expect("a particle");
        assert!(cloth.fabric().expect("a fabric").is_pinned(particle));
    }
    let below = cloth.vertex_position((COUNT * COUNT) as u32 - 1).expect("a vertex");
    assert!(below.distance(Vec3::new(1.0, -1.0, 0.0)) < 0.01, "{below}");
    assert_eq!(cloth.vertex_position((COUNT * COUNT) as u32), None);
}

#[test]
fn the_resolution_can_be_changed_and_removed() {
    let mut app = app();
    let held = (sheet(), Attachment::in_place(ClothEdge::Top), Transform::default());
    let cloth = app.world_mut().spawn((held, ClothResolution::CellSize(0.1))).id();
    run(&mut app, 10);
    let count = |app: &bevy_app::App| state(app, cloth).positions().len();
    let first = count(&app);
    app.world_mut().entity_mut(cloth).insert(ClothResolution::Particles(400));
    run(&mut app, 10);
    let second = count(&app);
    assert!(first < 200 && (320..480).contains(&second), "{first}, {second}");
    // An impossible one is reported, and the last good one is kept.
    app.world_mut().entity_mut(cloth).insert(ClothResolution::CellSize(f32::NAN));
    run(&mut app, 10);
    assert_eq!(app.world().resource::<Seen<ClothFailed>>().0.len(), 1);
    assert_eq!(count(&app), second);
    app.world_mut().entity_mut(cloth).remove::<ClothResolution>();
    run(&mut app, 10);
    assert!((800..1200).contains(&count(&app)), "{}", count(&app));
    assert_finite(&app, cloth);
}

#[test]
fn coarser_levels_have_cells_twice_as_large() {
    let mut app = app();
    let held = (sheet(), Attachment::in_place(ClothEdge::Top), Transform::default());
    let lods = |level: usize| LodSet { pinned: Some(level), ..LodSet::new([5.0, 10.0]) };
    let resolution = ClothResolution::CellSize(0.05);
    let cloth = app.world_mut().spawn((held, resolution, lods(0))).id();
    let wind = WindField { velocity: Vec3::new(0.0, 0.0, 3.0), ..WindField::default() };
    app.world_mut().spawn(wind);
    let mut counts = Vec::new();
    for level in [0, 1, 2, 1, 0] {
        app.world_mut().entity_mut(cloth).insert(lods(level));
        run(&mut app, 60);
        assert_finite(&app, cloth);
        let now = state(&app, cloth);
        assert_eq!(now.level(), level);
        counts.push(now.positions().len());
        for vertex in 0..COUNT as u32 {
            let at = now.vertex_position(vertex).expect("a vertex");
            assert!(at.distance(Vec3::X * vertex as f32 / (COUNT - 1) as f32) < 1e-6, "{at}");
        }
    }
    assert!(app.world().resource::<Seen<ClothFailed>>().0.is_empty());
    assert_eq!([counts[3], counts[4]], [counts[1], counts[0]]);
    assert!(counts[0] > 3 * counts[1] && counts[1] > 2 * counts[2], "{counts:?}");
}

#[test]
fn springs_and_grabs_hold_vertices_that_have_no_particle() {
    let mut app = app();
    let hand = app.world_mut().spawn(Transform::from_xyz(1.0, -1.0, 0.0)).id();
    let held = (sheet(), Attachment::in_place(ClothEdge::Top), Transform::default());
    let cloth = app.world_mut().spawn((held, ClothResolution::CellSize(0.17))).id();
    run(&mut app, 5);
    let corner = GrabbedVertices::List(vec![(COUNT * COUNT) as u32 - 1]);
    app.world_mut()
        .entity_mut(hand)
        .insert(ClothGrab { stiffness: 2000.0, ..ClothGrab::new(cloth, corner) });
    run(&mut app, 5);
    app.world_mut().get_mut::<Transform>(hand).expect("a hand").translation.z = 0.5;
    run(&mut app, 120);
    let at = state(&app, cloth).vertex_position((COUNT * COUNT) as u32 - 1).expect("a vertex");
    assert!(at.z > 0.4, "{at}");
}

/// Greatest distance of a vertex between two ticks, m.
fn jump(
    app: &mut bevy_app::App,
    cloth: bevy_ecs::entity::Entity,
    change: impl FnOnce(&mut bevy_app::App),
) -> f32 {
    let places = |app: &bevy_app::App| -> Vec<Vec3> {
        let vertices = 0..(COUNT * COUNT) as u32;
        vertices.filter_map(|vertex| state(app, cloth).vertex_position(vertex)).collect()
    };
    let before = places(app);
    change(app);
    run(app, 1);
    let after = places(app);
    assert_eq!(before.len(), after.len());
    before.iter().zip(&after).map(|(one, other)| one.distance(*other)).fold(0.0, f32::max)
}

#[test]
fn a_cloth_keeps_its_shape_when_vertices_are_let_go_or_the_resolution_changes() {
    let mut app = app();
    app.world_mut().spawn(WindField::steady(Vec3::new(0.0, 0.0, 4.0)));
    let corners = [ClothCorner::TopLeft, ClothCorner::TopRight];
    let held = AttachedVertices::Corners(corners.to_vec());
    let held = (sheet(), Attachment::in_place(held), Transform::default());
    let cloth = app.world_mut().spawn((held, ClothResolution::CellSize(0.07))).id();
    run(&mut app, 90);
    let flown = state(&app, cloth).vertex_position((COUNT * COUNT) as u32 - 1).expect("a vertex");
    assert!(flown.z > 0.3, "{flown}");
    let usual = jump(&mut app, cloth, |_| ());
    let other = jump(&mut app, cloth, |app| {
        app.world_mut().entity_mut(cloth).insert(ClothResolution::CellSize(0.05));
    });
    let let_go = jump(&mut app, cloth, |app| {
        let held = AttachedVertices::from(corners[0]);
        app.world_mut().entity_mut(cloth).insert(Attachment::in_place(held));
    });
    let free = jump(&mut app, cloth, |app| {
        app.world_mut().entity_mut(cloth).remove::<Attachment>();
    });
    for moved in [other, let_go, free] {
        assert!(moved < usual + 0.02, "{moved} m, without a change {usual} m");
    }
    run(&mut app, 60);
    assert_finite(&app, cloth);
    let fallen = state(&app, cloth).vertex_position(0).expect("a vertex");
    assert!(fallen.y < -1.0, "it falls: {fallen}");
}

#[test]
fn what_lies_between_held_vertices_is_held_with_them() {
    let mut app = app();
    let [left, right] = [(); 2].map(|()| app.world_mut().spawn(Transform::default()).id());
    let list = |vertices: [u32; 2]| AttachedVertices::List(vertices.to_vec());
    let attachment =
        Attachment::new(left, list([0, 1])).with_anchor(Anchor::new(right, list([2, 3])));
    let cloth = (sheet(), attachment, ClothResolution::CellSize(0.05));
    let cloth = app.world_mut().spawn(cloth).id();
    run(&mut app, 3);
    for step in 0..30 {
        let to = Vec3::new(-0.003 * step as f32, 0.0, 0.01 * step as f32);
        app.world_mut().get_mut::<Transform>(right).expect("a hand").translation = to;
        run(&mut app, 1);
    }
    run(&mut app, 120);
    let moved = Vec3::new(-0.087, 0.0, 0.29);
    let state = state(&app, cloth);
    let fabric = state.fabric().expect("a fabric");
    let mut counts = [0; 3];
    for (particle, rest) in fabric.rest_positions().iter().enumerate() {
        if !fabric.is_pinned(particle) {
            continue;
        }
        // All of the upper edge is held: on each hand, and evenly between both.
        let part = ((rest.x - 1.0 / 3.0) * 3.0).clamp(0.0, 1.0);
        let off = state.positions()[particle].distance(*rest + part * moved);
        assert!(rest.y == 0.0 && off < 1e-4, "{rest}: {off} m");
        counts[if part == 0.0 {
            0
        } else if part == 1.0 {
            2
        } else {
            1
        }] += 1;
    }
    assert!(counts.iter().all(|&count| count > 4), "{counts:?}");
}
