//! Tests of meshes that are drawn on particles of the cloth's own.

use bunting_solver::Grid;

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
    assert_eq!(positions(&app, cloth).len(), 33 * 17, "to the cells of the cloth, and once more");
    assert_eq!(failures(&app), []);
}

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

#[test]
fn a_detailed_mesh_is_simulated_with_few_particles_and_drawn_with_all_vertices() {
    let mut app = app(TICK);
    let (given, mesh_at_rest) = detailed(&mut app);
    let rest = values(&mesh_at_rest, Mesh::ATTRIBUTE_POSITION).clone();
    let few = (ClothFromMesh::painted(), ClothResolution::Particles(120), ClothSubdivision::NONE);
    let cloth = app.world_mut().spawn((given, few)).id();
    run(&mut app, 100);
    assert_eq!(failures(&app), []);
    let count = surface(&app, cloth).positions.len();
    assert!((100..=140).contains(&count), "{count} particles");
    let drawn = mesh(&app, cloth);
    assert_eq!(drawn.count_vertices(), rest.len());
    let color = Mesh::ATTRIBUTE_COLOR;
    assert_eq!(drawn.attribute(color), mesh_at_rest.attribute(color));
    // What is painted stays, and the sheet is whole.
    let points = |values: &[[f32; 3]]| values.iter().copied().map(Vec3::from).collect::<Vec<_>>();
    let (drawn, at_rest) = (points(positions(&app, cloth)), points(&rest));
    let last = rest.len() - 1;
    assert!(drawn[last].distance(at_rest[last]) > 0.05, "it flies");
    let rows = drawn.chunks(SIDE as usize).zip(at_rest.chunks(SIDE as usize));
    let pins = rows.clone().map(|(now, rest)| now[0].distance(rest[0])).fold(0.0, f32::max);
    let edge = |pair: &[Vec3]| pair[0].distance(pair[1]) * (SIDE - 1) as f32;
    let edges: Vec<f32> = rows.flat_map(|(now, _)| now.windows(2).map(edge)).collect();
    let longest = edges.iter().copied().fold(0.0, f32::max);
    let mean = edges.iter().sum::<f32>() / edges.len() as f32;
    assert!(pins < 1e-6, "pins are drawn {pins} m from their places");
    assert!((mean - 1.0).abs() < 0.02, "edges are {mean} times as long as at rest");
    assert!(longest < 1.2, "an edge is {longest} times as long as at rest");
    // The drawn mesh lies in its bounds.
    let bounds = app.world().get::<Aabb>(cloth).expect("bounds");
    let outside = |at: &Vec3| {
        let beyond = (Vec3A::from(*at) - bounds.center).abs() - bounds.half_extents;
        beyond.max_element() > 1e-6
    };
    assert!(!drawn.iter().any(outside), "{bounds:?}");
}

#[test]
fn painted_vertices_are_held_whatever_the_resolution() {
    let mut app = app(TICK);
    let (given, at_rest) = detailed(&mut app);
    let rest = values(&at_rest, Mesh::ATTRIBUTE_POSITION).clone();
    let paint = VertexPaint::Color(ColorChannel::Red);
    let held = vec![PaintedVertices { paint, least: 0.5 }];
    let from = ClothFromMesh { held, ..ClothFromMesh::default() };
    let attached = Attachment::in_place(ClothEdge::Bottom);
    let few = (from, attached, ClothResolution::Particles(120), ClothSubdivision::NONE);
    let cloth = app.world_mut().spawn((given, few)).id();
    run(&mut app, 60);
    let attachment = app.world().get::<Attachment>(cloth).expect("an attachment");
    let AttachedVertices::List(held) = &attachment.vertices else { panic!("{attachment:?}") };
    assert_eq!(held.len() as u32, SIDE);
    let drawn = positions(&app, cloth);
    for vertex in held.iter().map(|&vertex| vertex as usize) {
        assert!(Vec3::from(drawn[vertex]).distance(Vec3::from(rest[vertex])) < 1e-6);
    }
    assert!(drawn.last().expect("a mesh")[2] > 0.05, "the rest flies");
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
fn layers_and_tabs_can_be_simulated_with_any_number_of_particles() {
    let mut app = app(TICK);
    // The grid has vertices between the tabs that no triangle has.
    let from = ClothFromMesh { repair: true, ..ClothFromMesh::default() };
    let given = add(&mut app, quilt());
    let counts = [300, 500, 1000, 2000];
    let cloths = counts.map(|count| {
        let cloth = (given.clone(), from.clone(), ClothResolution::Particles(count));
        app.world_mut().spawn(cloth).id()
    });
    run(&mut app, 30);
    assert_eq!(failures(&app), []);
    for (cloth, count) in cloths.into_iter().zip(counts) {
        let state = app.world().get::<ClothState>(cloth).expect("a cloth");
        let particles = state.positions().len() as f32 / count as f32;
        assert!((0.7..1.5).contains(&particles), "{particles} of {count}");
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
    let from = ClothFromMesh { repair: false, ..ClothFromMesh::painted() };
    let cloth = app.world_mut().spawn((given, from)).id();
    run(&mut app, 5);
    let [ClothError::Mesh { entity, source }] = failures(&app) else {
        panic!("{:?}", failures(&app))
    };
    let bunting_solver::FabricError::NonManifoldEdge { a, b } = *source else { panic!("{source}") };
    assert_eq!((*entity, [a.min(b), a.max(b)]), (cloth, [40, 41]));
}
