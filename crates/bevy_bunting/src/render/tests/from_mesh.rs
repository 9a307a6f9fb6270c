//! Tests of cloths that are made of the meshes that entities have.

use bevy_asset::AssetServer;
use bevy_mesh::{Indices, MeshVertexAttribute, PrimitiveTopology, VertexFormat};

use super::*;

const PIN: MeshVertexAttribute = MeshVertexAttribute::new("Pin", 77_001, VertexFormat::Float32);

/// The flag's mesh with all that an artist's mesh has: the left column is red and has the attribute `Pin`.
fn painted(app: &mut App) -> Mesh {
    let mesh = flag_mesh(app);
    let is_left = |vertex: usize| if vertex.is_multiple_of(9) { 1.0 } else { 0.0 };
    let color = |vertex| [is_left(vertex), 0.2, vertex as f32, 1.0];
    mesh.with_inserted_attribute(Mesh::ATTRIBUTE_TANGENT, vec![[1.0, 0.0, 0.0, -1.0]; 45])
        .with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, (0..45).map(color).collect::<Vec<_>>())
        .with_inserted_attribute(PIN, (0..45).map(is_left).collect::<Vec<f32>>())
}

fn colors(mesh: &Mesh) -> &[[f32; 4]] {
    match mesh.attribute(Mesh::ATTRIBUTE_COLOR) {
        Some(VertexAttributeValues::Float32x4(colors)) => colors,
        other => panic!("{other:?}"),
    }
}

fn spawn_from(app: &mut App, mesh: &Mesh3d, from: ClothFromMesh) -> Entity {
    app.world_mut().spawn((mesh.clone(), from, ClothSubdivision::NONE)).id()
}

fn shape(app: &App, cloth: Entity) -> Option<&ClothMesh> {
    app.world().get(cloth)
}

#[test]
fn a_mesh_becomes_a_cloth_when_it_is_loaded_and_keeps_what_the_artist_made() {
    let mut app = app(TICK);
    let artists = painted(&mut app);
    let handle_of_file = app.world().resource::<Assets<Mesh>>().reserve_handle();
    let given = Mesh3d(handle_of_file.clone());
    let cloth = spawn_from(&mut app, &given, ClothFromMesh::painted());
    let other = spawn_from(&mut app, &given, ClothFromMesh::painted());
    app.world_mut().entity_mut(cloth).insert(LodSet::new([10.0]).pinned_to(1));
    run(&mut app, 5);
    assert_eq!(shape(&app, cloth), None);
    let mut meshes = app.world_mut().resource_mut::<Assets<Mesh>>();
    meshes.insert(handle_of_file.id(), artists.clone()).expect("a reserved handle");
    run(&mut app, 30);
    assert_eq!(failures(&app), []);
    for entity in [cloth, other] {
        assert_ne!(*handle(&app, entity), handle_of_file);
    }
    assert!(is_current(&app, other), "the cloth is shown");
    let shown = mesh(&app, other);
    assert_eq!(colors(shown), colors(&artists));
    assert_eq!(shown.attribute(Mesh::ATTRIBUTE_UV_0), artists.attribute(Mesh::ATTRIBUTE_UV_0));
    assert!(shown.contains_attribute(Mesh::ATTRIBUTE_TANGENT) && shown.contains_attribute(PIN));
    let [coarse, fine] = [cloth, other].map(|cloth| surface(&app, cloth).positions.len());
    assert!(2 * coarse < fine, "{coarse}, {fine}");
    let coarse = mesh(&app, cloth);
    assert!(coarse.contains_attribute(PIN));
    assert_eq!(colors(coarse), colors(&artists));
    // Pinned vertices stay, others are blown away, and the file's own mesh is not written.
    let (now, rest) = (positions(&app, other), values(&artists, Mesh::ATTRIBUTE_POSITION));
    for vertex in 0..45 {
        let moved = Vec3::from(now[vertex]).distance(Vec3::from(rest[vertex]));
        assert_eq!(moved < ROUNDING, vertex % 9 == 0, "vertex {vertex}: {moved} m");
    }
    let source = app.world().resource::<Assets<Mesh>>().get(&handle_of_file).expect("kept");
    assert_eq!(values(source, Mesh::ATTRIBUTE_POSITION), rest);
}

#[test]
fn weights_are_read_from_a_named_attribute() {
    let mut app = app(TICK);
    let mesh = painted(&mut app);
    let rest: Vec<Vec3> =
        values(&mesh, Mesh::ATTRIBUTE_POSITION).iter().copied().map(Vec3::from).collect();
    let given = add(&mut app, mesh);
    let by_name = |name: &str| ClothFromMesh {
        weights: Some(PaintedWeights::above(VertexPaint::Attribute(name.to_owned()), 0.5)),
        ..ClothFromMesh::default()
    };
    let cloth = spawn_from(&mut app, &given, by_name("Pin"));
    let missing = spawn_from(&mut app, &given, by_name("pin"));
    run(&mut app, 30);
    assert_ne!(Vec3::from(positions(&app, cloth)[44]), rest[44], "the copy is written");
    let weights = shape(&app, cloth).expect("a cloth").weights();
    assert!((0..45).all(|vertex| (weights[vertex] == 0.0) == (vertex % 9 == 0)));
    assert_eq!(failures(&app), [ClothError::NotPainted { entity: missing, key: "pin" }]);
    assert_eq!(shape(&app, missing), None);
    // A change makes the cloth, from the mesh that was given.
    app.world_mut().entity_mut(missing).insert(by_name("Pin"));
    app.world_mut().entity_mut(cloth).insert(ClothFromMesh::default());
    run(&mut app, 30);
    assert_eq!(failures(&app).len(), 1);
    assert!(shape(&app, missing).is_some_and(|shape| shape.weights().contains(&0.0)));
    let ClothMesh::Triangles { positions, weights, .. } = shape(&app, cloth).expect("a cloth")
    else {
        panic!("triangles")
    };
    assert_eq!((positions, &weights[..]), (&rest, &[][..]));
}

#[test]
fn each_anchor_holds_the_vertices_that_are_painted_for_it() {
    let mut app = app(TICK);
    let mesh = painted(&mut app);
    let rest = values(&mesh, Mesh::ATTRIBUTE_POSITION).clone();
    let given = add(&mut app, mesh);
    // The left column, and those of the colours' blue channel from 40 on: five vertices of the lowest row.
    let list = |paint, least| PaintedVertices { paint, least };
    let pins = list(VertexPaint::Attribute("Pin".to_owned()), 0.5);
    let hem = list(VertexPaint::Color(ColorChannel::Blue), 40.0);
    let from = |held: &[&PaintedVertices]| ClothFromMesh {
        held: held.iter().copied().cloned().collect(),
        ..ClothFromMesh::default()
    };
    let [mast, car] =
        [0.0, 1.0].map(|x| app.world_mut().spawn(Transform::from_xyz(x, 0.0, 0.0)).id());
    let none = || AttachedVertices::List(Vec::new());
    let back = Transform::from_xyz(-1.0, 0.0, 0.0);
    let anchored =
        Attachment::new(mast, none()).with_anchor(Anchor::new(car, none()).with_offset(back));
    let cloth = spawn_from(&mut app, &given, from(&[&pins, &hem]));
    app.world_mut().entity_mut(cloth).insert(anchored);
    let other = spawn_from(&mut app, &given, from(&[&pins, &hem]));
    app.world_mut().entity_mut(other).insert(Attachment::new(mast, none()));
    run(&mut app, 30);
    let missing = ClothError::PaintedNotHeld { entity: other, painted: 2, holders: 1 };
    assert_eq!(failures(&app), [missing]);
    app.world_mut().get_mut::<Transform>(car).expect("a car").translation.y = 0.1;
    run(&mut app, 120);
    for (vertex, now) in positions(&app, cloth).iter().enumerate() {
        let lifted = if vertex >= 40 { 0.1 } else { 0.0 };
        let place = Vec3::from(rest[vertex]) + lifted * Vec3::Y;
        let is_held = vertex % 9 == 0 || vertex >= 40;
        assert_eq!(place.distance(Vec3::from(*now)) < ROUNDING, is_held, "vertex {vertex}");
    }
}

#[test]
fn meshes_that_cannot_be_read_are_reported_once_and_others_go_on() {
    let mut app = app(TICK);
    let mut hidden = painted(&mut app);
    hidden.asset_usage = RenderAssetUsages::RENDER_WORLD;
    let hidden = add(&mut app, hidden);
    let unreadable = spawn_from(&mut app, &hidden, ClothFromMesh::default());
    let missing = Mesh3d(app.world().resource::<AssetServer>().load("no such file.mesh"));
    let missing = spawn_from(&mut app, &missing, ClothFromMesh::default());
    let sound = painted(&mut app);
    let sound = add(&mut app, sound);
    let sound = spawn_from(&mut app, &sound, ClothFromMesh::painted());
    for _ in 0..200 {
        run(&mut app, 1);
        std::thread::sleep(Duration::from_millis(1));
    }
    let expected = [
        ClothError::MeshUnreadable { entity: unreadable },
        ClothError::MeshNotLoaded { entity: missing },
    ];
    assert_eq!(failures(&app), expected);
    assert!(shape(&app, unreadable).is_none() && shape(&app, missing).is_none());
    assert!(is_current(&app, sound));
}

#[test]
fn a_defective_mesh_is_repaired_if_asked() {
    // Two triangles that touch in vertex 2 only, and vertex 1 without triangles.
    let at = [[0.0, 0.0], [9.0, 9.0], [1.0, 1.0], [1.0, 0.0], [2.0, 1.0], [2.0, 2.0]];
    let positions: Vec<[f32; 3]> = at.iter().map(|&[x, y]| [x, y, 0.0]).collect();
    let colors: Vec<[f32; 4]> = (0..6).map(|vertex| [0.0, vertex as f32, 0.0, 1.0]).collect();
    let mesh = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, vec![[0.0, 0.0, 1.0]; 6])
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, colors)
        .with_inserted_indices(Indices::U16(vec![0, 3, 2, 2, 4, 5]));
    let mut app = app(TICK);
    let given = add(&mut app, mesh);
    let defective = spawn_from(&mut app, &given, ClothFromMesh::default());
    let repair = ClothFromMesh { repair: true, ..ClothFromMesh::default() };
    let repaired = spawn_from(&mut app, &given, repair);
    run(&mut app, 10);
    assert!(
        matches!(failures(&app), [ClothError::Mesh { entity, .. }] if *entity == defective),
        "{:?}",
        failures(&app)
    );
    let shown = mesh_colors(&app, repaired);
    assert_eq!(shown, [0.0, 2.0, 3.0, 4.0, 5.0, 2.0]);
    // The split vertex is in two places, which part in the air.
    let state = app.world().get::<ClothState>(repaired).expect("a cloth");
    let [one, other] = [1, 5].map(|vertex| state.particle_of_vertex(vertex));
    assert_ne!(one, other);
}

/// The green channels of a cloth's mesh.
fn mesh_colors(app: &App, cloth: Entity) -> Vec<f32> {
    colors(mesh(app, cloth)).iter().map(|color| color[1]).collect()
}

#[test]
fn scales_are_baked_and_mirrored_meshes_turned() {
    let mut app = app(TICK);
    let given = painted(&mut app);
    let corner = Vec3::from(values(&given, Mesh::ATTRIBUTE_POSITION)[44]);
    let given = add(&mut app, given);
    let parent = app.world_mut().spawn(Transform::from_scale(Vec3::new(2.0, 1.0, 1.0))).id();
    let local = Transform::from_xyz(1.0, 0.0, 0.0).with_scale(Vec3::new(-1.0, 3.0, 1.0));
    let cloth = (given, ClothFromMesh::painted(), local, ChildOf(parent), ClothPaused);
    let cloth = app.world_mut().spawn(cloth).id();
    run(&mut app, 3);
    assert_eq!(failures(&app), []);
    let ClothMesh::Triangles { positions, indices, .. } = shape(&app, cloth).expect("a cloth")
    else {
        panic!("triangles")
    };
    assert!(positions[44].abs_diff_eq(corner * Vec3::new(-2.0, 3.0, 1.0), ROUNDING));
    let [a, b, c] = [0, 1, 2].map(|corner| positions[indices[corner] as usize]);
    assert!((b - a).cross(c - a).z > 0.0, "the front still faces +z");
}

#[test]
fn regions_of_the_material_are_painted() {
    let mut app = app(TICK);
    let mesh = painted(&mut app);
    let given = add(&mut app, mesh);
    let by_name = |name: &str| {
        let paint = VertexPaint::Attribute(name.to_owned());
        let heavy = PaintedRegion { paint, density: 5.0, ..PaintedRegion::default() };
        ClothFromMesh { regions: vec![heavy], ..ClothFromMesh::painted() }
    };
    let cloth = spawn_from(&mut app, &given, by_name("Pin"));
    let missing = spawn_from(&mut app, &given, by_name("pin"));
    run(&mut app, 10);
    assert_eq!(failures(&app), [ClothError::NotPainted { entity: missing, key: "pin" }]);
    let fabric = app.world().get::<ClothState>(cloth).and_then(ClothState::fabric);
    let fabric = fabric.expect("a cloth");
    // Half of the first of eight columns of cells.
    let heavier = fabric.mass_area() / fabric.area();
    assert!(heavier > 1.02 && heavier < 1.4, "{heavier}");
}
