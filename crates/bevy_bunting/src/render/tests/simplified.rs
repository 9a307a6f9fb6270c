//! Tests of meshes that are simulated with fewer vertices than they are drawn with.

use bunting_solver::Grid;

use super::*;

/// Vertices of the detailed mesh along each side.
const SIDE: u32 = 33;

/// A detailed sheet of one metre whose left column is painted red.
fn detailed(app: &mut App) -> (Mesh3d, Mesh) {
    let grid = Grid::new(SIDE, SIDE, 1.0, 1.0);
    let builder = bunting_solver::FabricBuilder::grid(grid);
    let red = |vertex: u32| if vertex.is_multiple_of(SIDE) { 1.0 } else { 0.0 };
    let colors: Vec<[f32; 4]> = (0..SIDE * SIDE).map(|it| [red(it), 0.0, 0.0, 1.0]).collect();
    let uvs: Vec<[f32; 2]> = grid.uvs().iter().map(Vec2::to_array).collect();
    let mesh = Mesh::new(bevy_mesh::PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, arrays(builder.positions()))
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, vec![[0.0, 0.0, 1.0]; colors.len()])
        .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, uvs)
        .with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, colors)
        .with_inserted_indices(bevy_mesh::Indices::U32(builder.indices().to_vec()));
    (add(app, mesh.clone()), mesh)
}

fn with_at_most(vertices: Option<u32>) -> ClothFromMesh {
    ClothFromMesh { max_vertices: vertices, ..ClothFromMesh::painted() }
}

/// Waits until a cloth's free edge is drawn away from its place at rest.
fn wait(app: &mut App, cloth: Entity, rest: &[[f32; 3]]) {
    for _ in 0..1000 {
        run(app, 1);
        std::thread::yield_now();
        let last = rest.len() - 1;
        let now = positions(app, cloth);
        if now.len() == rest.len() && Vec3::from(now[last]).distance(Vec3::from(rest[last])) > 0.05
        {
            return;
        }
    }
    panic!("nothing moves the drawn mesh: {:?}", failures(app));
}

#[test]
fn a_detailed_mesh_is_simulated_with_few_vertices_and_drawn_with_all() {
    let mut app = app(TICK);
    let (given, mesh_at_rest) = detailed(&mut app);
    let rest = values(&mesh_at_rest, Mesh::ATTRIBUTE_POSITION).clone();
    let cloth = app.world_mut().spawn((given, with_at_most(Some(120)))).id();
    wait(&mut app, cloth, &rest);
    run(&mut app, 100);
    assert_eq!(failures(&app), []);
    let shape = app.world().get::<ClothMesh>(cloth).expect("a cloth");
    assert!((100..=120 + 33).contains(&shape.vertex_count()), "{}", shape.vertex_count());
    let drawn = mesh(&app, cloth);
    assert_eq!(drawn.count_vertices(), rest.len());
    let color = Mesh::ATTRIBUTE_COLOR;
    assert_eq!(drawn.attribute(color), mesh_at_rest.attribute(color));
    // What is painted stays, and the sheet is whole. The smooth surface is longer than its chords where the free edge
    // flutters.
    let points = |values: &[[f32; 3]]| values.iter().copied().map(Vec3::from).collect::<Vec<_>>();
    let (drawn, at_rest) = (points(positions(&app, cloth)), points(&rest));
    let rows = drawn.chunks(SIDE as usize).zip(at_rest.chunks(SIDE as usize));
    let pins = rows.clone().map(|(now, rest)| now[0].distance(rest[0])).fold(0.0, f32::max);
    let edge = |pair: &[Vec3]| pair[0].distance(pair[1]) * (SIDE - 1) as f32;
    let edges: Vec<f32> = rows.flat_map(|(now, _)| now.windows(2).map(edge)).collect();
    let longest = edges.iter().copied().fold(0.0, f32::max);
    let mean = edges.iter().sum::<f32>() / edges.len() as f32;
    assert!(pins < 1e-3, "pins are drawn {pins} m from their places");
    assert!((mean - 1.0).abs() < 0.02, "edges are {mean} times as long as at rest");
    assert!(longest < 2.0, "an edge is {longest} times as long as at rest");
    // The drawn mesh lies in its bounds.
    let bounds = app.world().get::<Aabb>(cloth).expect("bounds");
    let outside = |at: &Vec3| {
        let beyond = (Vec3A::from(*at) - bounds.center).abs() - bounds.half_extents;
        beyond.max_element() > 1e-6
    };
    assert!(!drawn.iter().any(outside), "{bounds:?}");
}

#[test]
fn the_number_of_vertices_can_be_changed_and_taken_back() {
    let mut app = app(TICK);
    let (given, mesh_at_rest) = detailed(&mut app);
    let rest = values(&mesh_at_rest, Mesh::ATTRIBUTE_POSITION).clone();
    let none = ClothSubdivision::NONE;
    let cloth = app.world_mut().spawn((given, with_at_most(None), none)).id();
    let count = |app: &App| app.world().get::<ClothMesh>(cloth).map(ClothMesh::vertex_count);
    for (most, least, greatest) in [(None, 1089, 1089), (Some(200), 150, 233), (None, 1089, 1089)] {
        app.world_mut().entity_mut(cloth).insert(with_at_most(most));
        run(&mut app, 3);
        wait(&mut app, cloth, &rest);
        let count = count(&app).expect("a cloth");
        assert!((least..=greatest).contains(&count), "{count} for {most:?}");
        assert_eq!(app.world().get::<crate::ClothDeformer>(cloth).is_some(), most.is_some());
    }
    assert!(is_current(&app, cloth), "each particle is drawn again");
    assert_eq!(failures(&app), []);
}

#[test]
fn held_vertices_stay() {
    let mut app = app(TICK);
    let (given, _) = detailed(&mut app);
    let paint = VertexPaint::Color(ColorChannel::Red);
    let held = vec![PaintedVertices { paint, least: 0.5 }];
    let from = ClothFromMesh { held, max_vertices: Some(120), ..ClothFromMesh::default() };
    let attached = Attachment::in_place(ClothEdge::Left);
    let cloth = app.world_mut().spawn((given, from, attached)).id();
    run(&mut app, 3);
    let attachment = app.world().get::<Attachment>(cloth).expect("an attachment");
    let AttachedVertices::List(held) = &attachment.vertices else { panic!("{attachment:?}") };
    let shape = app.world().get::<ClothMesh>(cloth).expect("a cloth");
    let ClothMesh::Triangles { positions, .. } = shape else { panic!("triangles") };
    assert_eq!(held.len() as u32, SIDE);
    assert!(held.iter().all(|&vertex| positions[vertex as usize].x == 0.0));
    assert!(positions.len() <= 120);
}

/// A quilt with tabs: two layers, joined all around, that are 1 cm apart.
fn quilt() -> Mesh {
    let (cells, tabs) = (20, 6);
    let is_in = |x: i32, y: i32| {
        (0..cells).contains(&x) && y >= 0 && (y < cells || (y < cells + tabs && x % 3 == 1))
    };
    let index = |x: i32, y: i32, layer: i32| (2 * (y * (cells + 1) + x) + layer) as u32;
    let at = |index: i32| {
        let (layer, x, y) = (index % 2, index / 2 % (cells + 1), index / 2 / (cells + 1));
        let side = 1.0 / cells as f32;
        [x as f32 * side, -y as f32 * side, 0.01 * layer as f32]
    };
    let positions: Vec<[f32; 3]> = (0..2 * (cells + 1) * (cells + tabs + 1)).map(at).collect();
    let mut indices = Vec::new();
    let mut quad = |[a, b, c, d]: [u32; 4]| indices.extend([a, b, c, a, c, d]);
    for (x, y) in (0..cells + tabs).flat_map(|y| (0..cells).map(move |x| (x, y))) {
        if !is_in(x, y) {
            continue;
        }
        let corners = [(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)];
        let on = |layer: i32| corners.map(|(x, y)| index(x, y, layer));
        quad(on(0));
        let [a, b, c, d] = on(1);
        quad([a, d, c, b]);
        for (side, (dx, dy)) in [(0, -1), (1, 0), (0, 1), (-1, 0)].into_iter().enumerate() {
            if !is_in(x + dx, y + dy) {
                let [from, to] = [side, (side + 1) % 4];
                quad([on(0)[from], on(1)[from], on(1)[to], on(0)[to]]);
            }
        }
    }
    Mesh::new(bevy_mesh::PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
        .with_inserted_indices(bevy_mesh::Indices::U32(indices))
}

#[test]
fn layers_and_tabs_can_be_simulated_with_any_number_of_vertices() {
    let mut app = app(TICK);
    // The grid has vertices between the tabs that no triangle has.
    let from = |most: u32| ClothFromMesh {
        repair: true,
        max_vertices: Some(most),
        ..ClothFromMesh::default()
    };
    let given = add(&mut app, quilt());
    let cloths: Vec<Entity> = [100, 200, 300, 500]
        .map(|most| app.world_mut().spawn((given.clone(), from(most))).id())
        .to_vec();
    run(&mut app, 30);
    assert_eq!(failures(&app), []);
    for (cloth, most) in cloths.into_iter().zip([100, 200, 300, 500]) {
        let shape = app.world().get::<ClothMesh>(cloth).expect("a cloth");
        assert!(shape.vertex_count() <= most + most / 4, "{} of {most}", shape.vertex_count());
        assert!(app.world().get::<ClothState>(cloth).is_some_and(|it| !it.positions().is_empty()));
    }
}

#[test]
fn a_defect_of_the_given_mesh_is_named_by_its_own_vertices() {
    let mut app = app(TICK);
    let (_, mesh) = detailed(&mut app);
    // A fin on the edge from 40 to 41, which has two triangles.
    let Some(bevy_mesh::Indices::U32(indices)) = mesh.indices() else { panic!("indices") };
    let fin = [&indices[..], &[40, 41, 1000]].concat();
    let mesh = mesh.clone().with_inserted_indices(bevy_mesh::Indices::U32(fin));
    let given = add(&mut app, mesh);
    let pinned = ClothFromMesh { held: vec![], ..with_at_most(Some(1080)) };
    let cloth = app.world_mut().spawn((given, pinned)).id();
    run(&mut app, 5);
    let [ClothError::Mesh { entity, source }] = failures(&app) else {
        panic!("{:?}", failures(&app))
    };
    let bunting_solver::FabricError::NonManifoldEdge { a, b } = *source else { panic!("{source}") };
    assert_eq!((*entity, [a.min(b), a.max(b)]), (cloth, [40, 41]));
}
