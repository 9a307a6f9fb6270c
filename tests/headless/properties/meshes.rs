//! Meshes that are broken in any way: each becomes cloth, or is told.

use bevy_app::App;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::{Vec2, Vec3};
use bunting_tests::Seen;
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::select;

use super::beside::flag_goes_on;
use super::for_all;
use super::numbers::{number, uv, vector};

/// A change that breaks a mesh, or does not.
#[derive(Clone, Debug)]
enum Change {
    /// Moves a vertex.
    Move(usize, Vec3),
    /// Puts a vertex where another one is.
    Meet(usize, usize),
    /// Names another vertex for a corner.
    Corner(usize, u32),
    /// Leaves a triangle out.
    Hole(usize),
    /// Turns a triangle over.
    Flip(usize),
    /// Repeats a triangle.
    Twice(usize),
    /// Leaves out the last corner of all.
    Cut,
    /// Gives this vertex, and those before it, other texture coordinates.
    Texture(usize, Vec2),
}

fn change() -> BoxedStrategy<Change> {
    let at = || 0..100_usize;
    prop_oneof![
        3 => (at(), vector()).prop_map(|(at, to)| Change::Move(at, to)),
        2 => (at(), at()).prop_map(|(at, to)| Change::Meet(at, to)),
        2 => (at(), 0..30_u32).prop_map(|(at, to)| Change::Corner(at, to)),
        2 => at().prop_map(Change::Hole),
        1 => at().prop_map(Change::Flip),
        1 => at().prop_map(Change::Twice),
        1 => Just(Change::Cut),
        1 => (at(), uv()).prop_map(|(at, to)| Change::Texture(at, to)),
    ]
    .boxed()
}

/// The positions, indices and texture coordinates of a sheet that was changed.
fn changed_mesh(columns: u32, rows: u32, changes: &[Change]) -> (Vec<Vec3>, Vec<u32>, Vec<Vec2>) {
    let grid = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
    let places = grid.map(|(column, row)| Vec3::new(column as f32, -(row as f32), 0.0) * 0.2);
    let mut positions: Vec<Vec3> = places.collect();
    let cells = (0..rows - 1).flat_map(|row| (0..columns - 1).map(move |at| row * columns + at));
    let corners = cells.flat_map(|at| {
        let below = at + columns;
        [at, below, at + 1, at + 1, below, below + 1]
    });
    let mut indices: Vec<u32> = corners.collect();
    let mut uv = Vec::new();
    for change in changes {
        let (vertices, triangles) = (positions.len(), (indices.len() / 3).max(1));
        let corners = |triangle: usize| 3 * (triangle % triangles)..3 * (triangle % triangles) + 3;
        match *change {
            Change::Move(at, to) => positions[at % vertices] = to,
            Change::Meet(at, to) => positions[at % vertices] = positions[to % vertices],
            Change::Corner(at, to) if !indices.is_empty() => {
                let corner = at % indices.len();
                indices[corner] = to;
            }
            Change::Hole(at) if indices.len() >= 3 => drop(indices.drain(corners(at))),
            Change::Flip(at) if indices.len() >= 3 => indices[corners(at)].reverse(),
            Change::Twice(at) if indices.len() >= 3 => indices.extend_from_within(corners(at)),
            Change::Cut => drop(indices.pop()),
            Change::Texture(at, to) => uv.resize(at % (vertices + 1), to),
            _ => {}
        }
    }
    (positions, indices, uv)
}

fn mesh() -> BoxedStrategy<ClothMesh> {
    let changed = (2..6_u32, 2..6_u32, vec(change(), 0..5));
    let triangles = changed.prop_map(|(columns, rows, changes)| {
        let (positions, indices, uv) = changed_mesh(columns, rows, &changes);
        ClothMesh::triangles(positions, indices, uv)
    });
    let grid = (0..7_u32, 0..7_u32, number(), number())
        .prop_map(|(columns, rows, width, height)| ClothMesh::grid(columns, rows, width, height));
    let mesh = prop_oneof![3 => triangles, 1 => grid];
    (mesh, prop_oneof![3 => Just(Vec::new()), 1 => vec(number(), 4..25)])
        .prop_map(
            |(mesh, weights)| if weights.is_empty() { mesh } else { mesh.with_weights(weights) },
        )
        .boxed()
}

fn resolution() -> BoxedStrategy<ClothResolution> {
    // Of cells of millimetres there would be so many that they are built for longer than this test looks on.
    let bad = [0.0, -1.0, f32::NAN, f32::INFINITY, 1e-42, 1e-12, 1e25];
    prop_oneof![
        2 => Just(ClothResolution::Auto),
        2 => (0..400_u32).prop_map(ClothResolution::Particles),
        2 => (0.03_f32..1.0).prop_map(ClothResolution::CellSize),
        1 => select(bad.to_vec()).prop_map(ClothResolution::CellSize),
    ]
    .boxed()
}

#[test]
fn any_mesh_becomes_cloth_or_is_told() {
    let inputs = (
        mesh(),
        resolution(),
        prop_oneof![Just(ClothEdge::Left), Just(ClothEdge::Top)],
        any::<bool>(),
        0..3_usize,
    );
    for_all(64, inputs, |(mesh, resolution, edge, held, levels)| {
        let mut cloth = Entity::PLACEHOLDER;
        let spawn = |app: &mut App| {
            let lods = LodSet::new((0..levels).map(|at| 20.0 + at as f32).collect::<Vec<_>>());
            let mut spawned = app.world_mut().spawn((mesh, resolution, lods));
            if held {
                spawned.insert(Attachment::in_place(edge));
            }
            cloth = spawned.id();
        };
        let app = flag_goes_on(spawn, |_, ()| {});
        let state = app.world().get::<ClothState>(cloth).expect("a cloth");
        let told = &app.world().resource::<Seen<ClothFailed>>().0;
        assert!(!state.positions().is_empty() || told.iter().any(|it| it.entity == cloth));
        assert!(told.iter().all(|it| it.error.to_string().contains(&cloth.to_string())));
    });
}
