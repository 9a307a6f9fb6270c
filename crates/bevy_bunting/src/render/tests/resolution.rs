//! Tests of meshes that are drawn on particles of the cloth's own.

use super::*;

/// The flag as a mesh of triangles, in cells of its own.
fn spawn_resampled(app: &mut App, resolution: ClothResolution, more: impl Bundle) -> Entity {
    let builder = FLAG.builder();
    let (positions, indices) = (builder.positions().to_vec(), builder.indices().to_vec());
    let mesh = ClothMesh::triangles(positions, indices, FLAG.uvs());
    app.world_mut().spawn((mesh, resolution, Attachment::in_place(ClothEdge::Left), more)).id()
}

#[test]
fn the_mesh_follows_particles_of_the_cloths_own() {
    let mut app = app(TICK);
    let fine = ClothResolution::CellSize(0.06);
    let cloth = spawn_resampled(&mut app, fine, ClothSubdivision::NONE);
    run(&mut app, 60);
    assert_eq!(failures(&app), []);
    let shown = positions(&app, cloth).clone();
    assert_eq!(shown.len(), 45);
    let surface = &surface(&app, cloth).positions;
    assert!(surface.len() > 300, "{}", surface.len());
    let levels = app.world().get::<ClothState>(cloth).and_then(|state| state.levels.clone());
    let levels = levels.expect("a cloth");
    let mut farthest: f32 = 0.0;
    for (vertex, at) in (0..).zip(&shown) {
        let expected = levels.vertex_position(0, vertex, surface).expect("a vertex");
        assert_eq!(*at, expected.to_array());
        farthest = farthest.max(expected.distance(FLAG.builder().positions()[vertex as usize]));
    }
    assert!(farthest > 0.1, "it flies");
    for normal in values(mesh(&app, cloth), Mesh::ATTRIBUTE_NORMAL) {
        assert!((Vec3::from(*normal).length() - 1.0).abs() < ROUNDING);
    }
    // What is held stays where it is.
    for vertex in (0..45).step_by(9) {
        let rest = FLAG.builder().positions()[vertex];
        assert!(Vec3::from(shown[vertex]).distance(rest) < 1e-6);
    }
}

#[test]
fn the_mesh_is_the_same_at_all_levels_and_can_be_halved() {
    let mut app = app(TICK);
    let lods = |level: usize| LodSet { pinned: Some(level), ..LodSet::new([5.0]) };
    let cell = ClothResolution::CellSize(0.06);
    let cloth = spawn_resampled(&mut app, cell, (lods(0), ClothSubdivision::NONE));
    run(&mut app, 20);
    app.world_mut().entity_mut(cloth).insert(lods(1));
    run(&mut app, 60);
    assert_eq!(app.world().get::<ClothState>(cloth).map(ClothState::level), Some(1));
    assert_eq!(positions(&app, cloth).len(), 45);
    let halved = ClothSubdivision { edge: 4.0, halvings: 1 };
    app.world_mut().entity_mut(cloth).insert(halved);
    for _ in 0..200 {
        run(&mut app, 1);
        if positions(&app, cloth).len() > 45 {
            break;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    assert_eq!(positions(&app, cloth).len(), 17 * 9, "each cell has four");
    assert_eq!(failures(&app), []);
}
