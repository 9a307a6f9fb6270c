//! Tests of the subdivided meshes.

use super::*;
use crate::render::level_meshes::LevelMeshes;

/// Edges of the flag are some 40 px long from five metres away.
const FINE: ClothSubdivision = ClothSubdivision { edge: 12.0, halvings: 2 };

/// A finely drawn flag.
fn spawn_fine(app: &mut App, more: impl Bundle) -> Entity {
    let cloth = spawn(app, more);
    app.world_mut().entity_mut(cloth).insert(FINE);
    cloth
}

fn halvings(app: &App, cloth: Entity) -> u32 {
    app.world().get::<LevelMeshes>(cloth).expect("it is drawn").halvings
}

#[test]
fn a_near_cloth_is_drawn_smoothly_and_a_far_one_as_it_is() {
    let mut app = app(TICK);
    let cloth = spawn_fine(&mut app, ());
    run(&mut app, 30);
    assert_eq!(halvings(&app, cloth), 2);
    let (drawn, particles) = (positions(&app, cloth), &surface(&app, cloth).positions);
    assert_eq!(drawn.len(), 33 * 17);
    for (index, particle) in particles.iter().enumerate() {
        assert_eq!(drawn[4 * (index / 9) * 33 + 4 * (index % 9)], particle.to_array());
    }
    let normals = values(mesh(&app, cloth), Mesh::ATTRIBUTE_NORMAL);
    assert!(normals.iter().all(|&normal| (Vec3::from(normal).length() - 1.0).abs() < ROUNDING));
    let uv = mesh(&app, cloth).attribute(Mesh::ATTRIBUTE_UV_0);
    let Some(VertexAttributeValues::Float32x2(uv)) = uv else { panic!("texture coordinates") };
    assert_eq!((uv[1], uv[33 * 17 - 1]), ([1.0 / 32.0, 0.0], [1.0, 1.0]));

    // The same mesh is shown again when the cloth comes back.
    let near = handle(&app, cloth).clone();
    let mut cameras = app.world_mut().query_filtered::<&mut Transform, With<Camera3d>>();
    cameras.single_mut(app.world_mut()).expect("a camera").translation.z = 100.0;
    run(&mut app, 3);
    assert_eq!(halvings(&app, cloth), 0);
    assert!(is_current(&app, cloth));
    cameras.single_mut(app.world_mut()).expect("a camera").translation.z = 5.0;
    run(&mut app, 3);
    assert_eq!(*handle(&app, cloth), near);
    assert!(failures(&app).is_empty());
}

#[test]
fn cloth_at_rest_is_not_written_and_out_of_view_nothing_is_made() {
    let mut app = app(TICK);
    let cloth = spawn_fine(&mut app, ());
    let behind = spawn_fine(&mut app, Transform::from_xyz(0.0, 0.0, 50.0));
    run(&mut app, 5);
    assert_eq!((halvings(&app, cloth), halvings(&app, behind)), (2, 0));
    modified(&mut app);
    run(&mut app, 1);
    assert_eq!(modified(&mut app), 1);
    app.world_mut().entity_mut(cloth).insert(ClothPaused);
    run(&mut app, 3);
    modified(&mut app);
    run(&mut app, 3);
    assert_eq!(modified(&mut app), 0);
    // Out of view it keeps its mesh.
    app.world_mut().entity_mut(cloth).insert(Transform::from_xyz(0.0, 0.0, 50.0));
    run(&mut app, 3);
    assert_eq!(halvings(&app, cloth), 2);
}

#[test]
fn a_mesh_that_is_no_grid_is_subdivided_beside_the_main_thread() {
    let mut app = app(TICK);
    let grid = bunting_solver::Grid::new(9, 9, 1.0, 1.0);
    let uv = grid.uvs();
    let grid = bunting_solver::FabricBuilder::grid(grid);
    let shape = ClothMesh::triangles(grid.positions().to_vec(), grid.indices().to_vec(), uv);
    let attachment = Attachment::in_place(ClothEdge::Top);
    let cloth = app.world_mut().spawn((shape, attachment, FINE)).id();
    for _ in 0..1000 {
        run(&mut app, 1);
        std::thread::yield_now();
        if app.world().get::<LevelMeshes>(cloth).is_some_and(|it| it.halvings > 0) {
            break;
        }
    }
    run(&mut app, 2);
    assert_eq!(positions(&app, cloth).len(), 33 * 33);
    let drawn = &positions(&app, cloth)[..81];
    let state = app.world().get::<ClothState>(cloth).expect("a cloth");
    let levels = state.levels.as_ref().expect("it is simulated");
    let surface = &surface(&app, cloth).positions;
    for (vertex, at) in (0..).zip(drawn) {
        let place = levels.vertex_position(0, vertex, surface).expect("a vertex");
        assert_eq!(*at, place.to_array());
    }
}

#[test]
fn bounds_hold_what_is_drawn() {
    let mut app = app(TICK);
    let cloth = spawn_fine(&mut app, ());
    run(&mut app, 5);
    for _ in 0..100 {
        run(&mut app, 1);
        let bounds = app.world().get::<Aabb>(cloth).expect("bounds");
        for &at in positions(&app, cloth) {
            let off = (Vec3A::from(at) - bounds.center).abs();
            assert!(off.cmple(bounds.half_extents + ROUNDING).all(), "{at:?}");
        }
    }
}

/// A switch moves no vertex of a flying flag by a pixel: it happens where an edge is short on the screen.
#[test]
fn a_switch_is_not_seen() {
    let mut app = app(TICK);
    let default = ClothSubdivision::default();
    let shape = ClothMesh::grid(33, 23, 1.5, 1.0);
    let cloth = spawn(&mut app, ());
    app.world_mut().entity_mut(cloth).insert((shape, ClothSubdivision { edge: 1.0, halvings: 1 }));
    run(&mut app, 200);
    let drawn = positions(&app, cloth);
    let at = |column: usize, row: usize| Vec3::from(drawn[row * 65 + column]);
    let mut moved: f32 = 0.0;
    for row in 0..45 {
        for column in (1..64).step_by(2) {
            let flat = 0.5 * (at(column - 1, row) + at(column + 1, row));
            moved = moved.max(flat.distance(at(column, row)));
        }
    }
    let pixels = moved * default.edge / (1.5 / 32.0);
    assert!(pixels < 0.75, "{pixels} px");
}
