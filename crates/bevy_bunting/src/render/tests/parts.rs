//! Tests of the meshes of cloths with a rigid part.

use super::*;

/// A square of 13 × 13 vertices, rigid in its upper part, which blends into the lower.
fn half_rigid() -> ClothMesh {
    let weight = |vertex: usize| ((vertex / 13) as f32 - 4.0).clamp(0.0, 2.0) / 2.0;
    ClothMesh::grid(13, 13, 1.0, 1.0).with_weights((0..169).map(weight).collect())
}

#[test]
fn rigid_vertices_are_drawn_in_their_place_at_every_level() {
    let mut app = app(TICK);
    let levels = LodSet::new([10.0]).pinned_to(0);
    let attachment = Attachment::in_place(AttachedVertices::Rigid);
    let cells = ClothResolution::CellSize(1.0 / 12.0);
    let cloth = app.world_mut().spawn((half_rigid(), attachment, levels, cells)).id();
    let mut areas = Vec::new();
    for level in [0, 1, 0] {
        app.world_mut().get_mut::<LodSet>(cloth).expect("levels").pinned = Some(level);
        run(&mut app, 30);
        let state = app.world().get::<ClothState>(cloth).expect("a state");
        // Nine rows of thirteen, as far as lines of the lattice lie on borders.
        let count = state.positions().len();
        assert!(count <= 13 * 10, "only the lower part is simulated: {count}");
        let mesh = mesh(&app, cloth);
        let at = positions(&app, cloth);
        let Some(VertexAttributeValues::Float32x2(uvs)) = mesh.attribute(Mesh::ATTRIBUTE_UV_0)
        else {
            panic!("it has texture coordinates")
        };
        let normals = values(mesh, Mesh::ATTRIBUTE_NORMAL);
        let mut rigid = 0;
        for ((at, uv), normal) in at.iter().zip(uvs).zip(normals) {
            let rest = Vec3::new(uv[0], -uv[1], 0.0);
            if uv[1] < 4.5 / 12.0 {
                assert!((Vec3::from(*at) - rest).length() < ROUNDING, "{at:?} {rest}");
                assert!((Vec3::from(*normal) - Vec3::Z).length() < ROUNDING, "{normal:?}");
                rigid += 1;
            } else if uv[1] > 0.99 {
                assert!(at[2] > 0.1, "the wind moves it");
            }
        }
        assert_eq!(rigid, 5 * 13, "all of them are there");
        let mut area = 0.0;
        let corners: Vec<usize> = mesh.indices().expect("triangles").iter().collect();
        for [a, b, c] in corners.as_chunks::<3>().0 {
            let [a, b, c] = [a, b, c].map(|&corner| Vec2::from(uvs[corner]));
            area += 0.5 * (b - a).perp_dot(c - a).abs();
        }
        areas.push(area);
        let bounds = app.world().get::<Aabb>(cloth).expect("bounds");
        assert!(bounds.max().y >= 0.0 && bounds.min().x <= 0.0, "{bounds:?}");
    }
    assert!(areas.iter().all(|area| (area - 1.0).abs() < 1e-4), "no holes: {areas:?}");
}

#[test]
fn vertices_that_become_rigid_return_to_rest_in_a_given_mesh() {
    let mut app = app(TICK);
    let all = half_rigid().with_weights(vec![1.0; 169]);
    let attachment = Attachment::in_place(ClothEdge::Top);
    let maker = app.world_mut().spawn((all.clone(), attachment.clone())).id();
    run(&mut app, 3);
    let given = mesh(&app, maker).clone();
    let given = add(&mut app, given);
    let cloth = app.world_mut().spawn((all, attachment, given)).id();
    run(&mut app, 30);
    let moved = |app: &App| positions(app, cloth)[13 * 4][2].abs();
    assert!(moved(&app) > 0.01);
    app.world_mut().entity_mut(cloth).insert(half_rigid());
    run(&mut app, 3);
    assert_eq!(moved(&app), 0.0);
    let normal = Vec3::from(values(mesh(&app, cloth), Mesh::ATTRIBUTE_NORMAL)[13]);
    assert!((normal - Vec3::Z).length() < ROUNDING, "{normal}");
}
