//! Tests of the meshes of levels of detail.

use bunting_solver::{FabricBuilder, Grid, LinkFamily};

use super::*;

#[test]
fn a_level_has_its_mesh() {
    let mut app = app(TICK);
    let levels = LodSet::new([10.0, 20.0]);
    let cloth = spawn(&mut app, levels.clone().pinned_to(0));
    run(&mut app, 10);
    let fine = handle(&app, cloth).clone();
    let count = app.world().resource::<Assets<Mesh>>().len();
    app.world_mut().entity_mut(cloth).insert(levels.clone().pinned_to(1));
    // The change of level is eased with the finer mesh.
    run(&mut app, 2);
    assert_eq!(*handle(&app, cloth), fine);
    run(&mut app, 20);
    let coarse = handle(&app, cloth).clone();
    assert_ne!(coarse, fine);
    assert_eq!(positions(&app, cloth).len(), 15);
    assert!(is_current(&app, cloth));
    let Some(VertexAttributeValues::Float32x2(uv)) =
        mesh(&app, cloth).attribute(Mesh::ATTRIBUTE_UV_0)
    else {
        panic!("the finest has texture coordinates")
    };
    assert_eq!((uv[0], uv[1], uv[14]), ([0.0, 0.0], [0.25, 0.0], [1.0, 1.0]));

    app.world_mut().entity_mut(cloth).insert(levels.pinned_to(0));
    run(&mut app, 1);
    assert_eq!(*handle(&app, cloth), fine);
    assert!(is_current(&app, cloth));
    assert_eq!(app.world().resource::<Assets<Mesh>>().len(), count);
}

/// A mesh that is no grid passes through its levels, and is drawn with all its vertices at each.
#[test]
fn any_mesh_is_drawn_whole_at_each_level() {
    let mut app = app(TICK);
    let grid = FabricBuilder::grid(Grid::new(13, 13, 1.0, 1.0)).build().expect("a square");
    let indices = grid.triangles().as_flattened().to_vec();
    let shape = ClothMesh::triangles(grid.rest_positions().to_vec(), indices, grid.uvs().to_vec());
    let levels = LodSet::new([10.0]).pinned_to(0);
    let attachment = Attachment::in_place(ClothEdge::Top);
    let cloth = app.world_mut().spawn((shape, attachment, levels, ClothSubdivision::NONE)).id();
    run(&mut app, 10);
    assert_eq!(positions(&app, cloth).len(), 169);
    app.world_mut().get_mut::<LodSet>(cloth).expect("levels").pinned = Some(1);
    run(&mut app, 30);
    let count = surface(&app, cloth).positions.len();
    assert!((200..400).contains(&count), "{count} particles");
    assert_eq!(positions(&app, cloth).len(), 169);
    assert!(is_current(&app, cloth));
    let Some(VertexAttributeValues::Float32x2(uv)) =
        mesh(&app, cloth).attribute(Mesh::ATTRIBUTE_UV_0)
    else {
        panic!("the finest has texture coordinates")
    };
    assert_eq!((uv[0], uv[168]), ([0.0, 0.0], [1.0, 1.0]));
    app.world_mut().get_mut::<LodSet>(cloth).expect("levels").pinned = Some(0);
    run(&mut app, 30);
    assert_eq!(positions(&app, cloth).len(), 169);
    assert!(is_current(&app, cloth));
    // Transfers between levels neither tear nor crumple the cloth.
    let state = app.world().get::<ClothState>(cloth).expect("a state");
    let links = state.fabric().expect("a fabric").links().iter();
    for link in links.filter(|link| link.family != LinkFamily::Diagonal) {
        let [a, b] = link.particles.map(|end| state.positions()[end as usize]);
        let stretch = a.distance(b) / link.rest_length;
        assert!((0.8..1.1).contains(&stretch), "{stretch}");
    }
}
