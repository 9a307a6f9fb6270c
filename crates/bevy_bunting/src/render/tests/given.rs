//! Tests of meshes that the user gives.

use super::*;

#[test]
fn a_given_mesh_is_written_in_place_with_its_tangents() {
    let mut app = app(TICK);
    let tangents = vec![[1.0, 0.0, 0.0, -1.0]; 45];
    let given = flag_mesh(&mut app).with_inserted_attribute(Mesh::ATTRIBUTE_TANGENT, tangents);
    let given = add(&mut app, given);
    let cloth = spawn(&mut app, (given.clone(), LodSet::new([10.0]).pinned_to(0)));
    run(&mut app, 30);
    assert_eq!(*handle(&app, cloth), given.0);
    assert!(is_current(&app, cloth));
    for level in [0, 1] {
        app.world_mut().get_mut::<LodSet>(cloth).expect("levels").pinned = Some(level);
        run(&mut app, 2);
        let mesh = mesh(&app, cloth);
        let Some(VertexAttributeValues::Float32x4(tangents)) =
            mesh.attribute(Mesh::ATTRIBUTE_TANGENT)
        else {
            panic!("it has tangents")
        };
        let (at, normals) =
            (values(mesh, Mesh::ATTRIBUTE_POSITION), values(mesh, Mesh::ATTRIBUTE_NORMAL));
        for (vertex, &[x, y, z, side]) in tangents.iter().enumerate() {
            let tangent = Vec3::new(x, y, z);
            assert!((tangent.length() - 1.0).abs() < ROUNDING);
            assert!(tangent.dot(Vec3::from(normals[vertex])).abs() < ROUNDING);
            assert_eq!(side, -1.0);
        }
        // u grows along the row.
        let along = (Vec3::from(at[1]) - Vec3::from(at[0])).normalize();
        assert!(Vec3::from_slice(&tangents[0]).dot(along) > 0.9);
    }
}

#[test]
fn a_seam_is_written_on_both_sides() {
    // Two squares share an edge, whose vertices the mesh has twice, as at a texture seam.
    let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)];
    let square = |x: f32| corners.map(|(dx, dy)| Vec3::new(x + dx, -dy, 0.0));
    let uv = corners.map(|(u, v)| Vec2::new(u, v));
    let indices = [0, 2, 1, 1, 2, 3];
    let shape = ClothMesh::triangles(
        [square(0.0), square(1.0)].concat(),
        [indices, indices.map(|index| index + 4)].concat(),
        [uv, uv].concat(),
    );
    let mut app = app(TICK);
    let attachment = Attachment::in_place(AttachedVertices::List(vec![0, 2]));
    let cloth = app.world_mut().spawn((shape, attachment, ClothSubdivision::NONE)).id();
    run(&mut app, 20);
    let at = positions(&app, cloth);
    assert_eq!(at.len(), 8);
    assert_eq!((at[1], at[3]), (at[4], at[6]));
    assert_ne!(at[1], [1.0, 0.0, 0.0]);
}

#[test]
fn a_mesh_of_two_cloths_is_copied() {
    let mut app = app(TICK);
    let given = flag_mesh(&mut app);
    let given = add(&mut app, given);
    let cloths =
        [5.0_f32, -5.0].map(|x| spawn(&mut app, (given.clone(), Transform::from_xyz(x, 0.0, 0.0))));
    run(&mut app, 5);
    assert_eq!(*handle(&app, cloths[0]), given.0);
    assert_ne!(*handle(&app, cloths[1]), given.0);
}

#[test]
fn a_mesh_that_cannot_be_written_is_reported_once() {
    let mut app = app(TICK);
    let good = flag_mesh(&mut app);
    let mut kept_by_renderer = good.clone();
    kept_by_renderer.asset_usage = RenderAssetUsages::RENDER_WORLD;
    let kept_by_renderer = add(&mut app, kept_by_renderer);
    let other = add(&mut app, Mesh::from(bevy_math::primitives::Cuboid::default()));
    let cloth = spawn(&mut app, kept_by_renderer);
    run(&mut app, 5);
    assert_eq!(failures(&app), [ClothError::MeshUnwritable { entity: cloth }]);
    app.world_mut().entity_mut(cloth).insert(other);
    run(&mut app, 5);
    let vertices = ClothError::MeshVertices { entity: cloth, given: 24, expected: 45 };
    assert_eq!(failures(&app)[1..], [vertices]);
    let good = add(&mut app, good);
    app.world_mut().entity_mut(cloth).insert(good);
    run(&mut app, 5);
    assert_eq!(failures(&app).len(), 2);
    assert!(is_current(&app, cloth));
}
