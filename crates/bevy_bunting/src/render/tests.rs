//! Meshes without a renderer: assets, cameras and visibility are all that it takes.

mod first_hour;
mod parts;

use std::time::{Duration, Instant};

use bevy_app::prelude::*;
use bevy_asset::{AssetEvent, AssetPlugin, Assets, Handle, RenderAssetUsages};
use bevy_camera::primitives::Aabb;
use bevy_camera::visibility::ViewVisibility;
use bevy_camera::{Camera3d, CameraPlugin};
use bevy_ecs::prelude::*;
use bevy_gizmos::config::GizmoConfigStore;
use bevy_gizmos::{GizmoHandles, GizmoPlugin};
use bevy_math::{Vec2, Vec3, Vec3A};
use bevy_mesh::{Mesh, Mesh3d, MeshPlugin, VertexAttributeValues};
use bevy_time::{TimePlugin, TimeUpdateStrategy};
use bevy_transform::prelude::*;
use bunting_solver::{FabricBuilder, Grid};

use super::{ClothDebugPlugin, ClothGizmos};
use crate::prelude::*;

const TICK: Duration = Duration::from_micros(15_625);

const FLAG: ClothMesh = ClothMesh::grid(9, 5, 1.5, 1.0);

/// Rounding of a direction.
const ROUNDING: f32 = 1e-5;

#[derive(Resource, Default)]
struct Failures(Vec<ClothError>);

/// An app with a camera that looks along −z from a few metres away, and wind.
fn app(frame: Duration) -> App {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TimePlugin, TransformPlugin))
        .add_plugins((AssetPlugin::default(), MeshPlugin, CameraPlugin, ClothPlugins::default()))
        .insert_resource(TimeUpdateStrategy::ManualDuration(frame))
        .init_resource::<Failures>()
        .add_observer(|failed: On<ClothFailed>, mut failures: ResMut<Failures>| {
            failures.0.push(failed.error);
        });
    app.world_mut().spawn(WindField::steady(Vec3::new(4.0, 0.0, 5.0)));
    app.world_mut().spawn((Camera3d::default(), Transform::from_xyz(0.0, 0.0, 5.0)));
    app
}

fn spawn(app: &mut App, more: impl Bundle) -> Entity {
    app.world_mut().spawn((FLAG, Attachment::in_place(ClothEdge::Left), more)).id()
}

fn run(app: &mut App, updates: usize) {
    (0..updates).for_each(|_| app.update());
}

fn add(app: &mut App, mesh: Mesh) -> Mesh3d {
    Mesh3d(app.world_mut().resource_mut::<Assets<Mesh>>().add(mesh))
}

/// The mesh of the flag, for one to come with.
fn flag_mesh(app: &mut App) -> Mesh {
    let cloth = spawn(app, ());
    run(app, 3);
    let mesh = mesh(app, cloth).clone();
    app.world_mut().despawn(cloth);
    mesh
}

fn handle(app: &App, cloth: Entity) -> &Handle<Mesh> {
    &app.world().get::<Mesh3d>(cloth).expect("the cloth has a mesh").0
}

fn mesh(app: &App, cloth: Entity) -> &Mesh {
    app.world().resource::<Assets<Mesh>>().get(handle(app, cloth)).expect("it is loaded")
}

fn values(mesh: &Mesh, attribute: bevy_mesh::MeshVertexAttribute) -> &Vec<[f32; 3]> {
    match mesh.attribute(attribute) {
        Some(VertexAttributeValues::Float32x3(values)) => values,
        other => panic!("{other:?}"),
    }
}

fn positions(app: &App, cloth: Entity) -> &Vec<[f32; 3]> {
    values(mesh(app, cloth), Mesh::ATTRIBUTE_POSITION)
}

fn arrays(vectors: &[Vec3]) -> Vec<[f32; 3]> {
    vectors.iter().map(Vec3::to_array).collect()
}

fn surface(app: &App, cloth: Entity) -> &ClothSurface {
    app.world().get(cloth).expect("the cloth is drawn")
}

fn is_current(app: &App, cloth: Entity) -> bool {
    *positions(app, cloth) == arrays(&surface(app, cloth).positions)
}

fn failures(app: &App) -> &[ClothError] {
    &app.world().resource::<Failures>().0
}

fn modified(app: &mut App) -> usize {
    let mut events = app.world_mut().resource_mut::<Messages<AssetEvent<Mesh>>>();
    events.drain().filter(|event| matches!(event, AssetEvent::Modified { .. })).count()
}

#[test]
fn a_mesh_is_the_surface_between_two_ticks() {
    let mut app = app(TICK.mul_f64(0.3));
    let cloth = spawn(&mut app, ());
    run(&mut app, 49);
    let state = app.world().get::<ClothState>(cloth).expect("a cloth");
    let (before, after) = (state.previous_positions()[8], state.positions()[8]);
    let shown = Vec3::from(positions(&app, cloth)[8]);
    let part = (shown - before).dot(after - before) / (after - before).length_squared();
    assert!(part > 0.05 && part < 0.95, "{part}");
    assert!(is_current(&app, cloth));
    let normals = values(mesh(&app, cloth), Mesh::ATTRIBUTE_NORMAL);
    assert_eq!(*normals, arrays(&surface(&app, cloth).normals));
    assert_eq!(mesh(&app, cloth).indices().map(bevy_mesh::Indices::len), Some(8 * 4 * 6));
    assert!(mesh(&app, cloth).contains_attribute(Mesh::ATTRIBUTE_UV_0));
}

#[test]
fn writing_allocates_nothing() {
    let mut app = app(TICK);
    let cloth = spawn(&mut app, ());
    run(&mut app, 3);
    let (pointer, old) = (positions(&app, cloth).as_ptr(), positions(&app, cloth).clone());
    run(&mut app, 10);
    assert_eq!(positions(&app, cloth).as_ptr(), pointer);
    assert_ne!(*positions(&app, cloth), old);
}

#[test]
fn what_stands_still_is_not_written() {
    let mut app = app(TICK);
    let cloth = spawn(&mut app, ());
    run(&mut app, 5);
    modified(&mut app);
    run(&mut app, 1);
    assert_eq!(modified(&mut app), 1);
    app.world_mut().entity_mut(cloth).insert(ClothPaused);
    run(&mut app, 3);
    modified(&mut app);
    run(&mut app, 3);
    assert_eq!(modified(&mut app), 0);
}

#[test]
fn a_level_has_its_mesh() {
    let mut app = app(TICK);
    let levels = LodSet::new([10.0, 20.0]);
    let cloth = spawn(&mut app, levels.clone().pinned_to(0));
    run(&mut app, 10);
    let fine = handle(&app, cloth).clone();
    let count = app.world().resource::<Assets<Mesh>>().len();
    app.world_mut().entity_mut(cloth).insert(levels.clone().pinned_to(1));
    // The finer mesh eases the surface across.
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

#[test]
fn bounds_hold_and_what_is_out_of_view_is_written_when_it_comes_back() {
    let mut app = app(TICK);
    let cloth = spawn(&mut app, ());
    run(&mut app, 10);
    let seen = |app: &App| app.world().get::<ViewVisibility>(cloth).expect("a mesh").get();
    assert!(seen(&app));

    app.world_mut().entity_mut(cloth).insert(Transform::from_xyz(0.0, 0.0, 50.0));
    run(&mut app, 2);
    assert!(!seen(&app));
    let old = positions(&app, cloth).clone();
    modified(&mut app);
    run(&mut app, 20);
    assert_eq!(*positions(&app, cloth), old);
    assert_eq!(modified(&mut app), 0);
    let bounds = app.world().get::<Aabb>(cloth).expect("a mesh has bounds");
    for &position in &surface(&app, cloth).positions {
        let off = (Vec3A::from(position) - bounds.center).abs() - bounds.half_extents;
        assert!(off.max_element() < ROUNDING, "{position} is out of {bounds:?}");
    }

    app.world_mut().entity_mut(cloth).insert(Transform::default());
    run(&mut app, 1);
    assert!(seen(&app));
    assert!(is_current(&app, cloth));
    assert_eq!(modified(&mut app), 1);
}

#[test]
fn a_given_mesh_is_written_in_place_tangents_and_all() {
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
    // Two squares that share an edge, whose vertices the texture has twice.
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
    let cloth = app.world_mut().spawn((shape, attachment)).id();
    run(&mut app, 20);
    let at = positions(&app, cloth);
    assert_eq!((at.len(), surface(&app, cloth).positions.len()), (8, 6));
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
fn a_mesh_that_cannot_be_written_is_named_once() {
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

#[test]
fn without_meshes_nothing_is_drawn() {
    let mut app = App::new();
    app.add_plugins((TimePlugin, TransformPlugin, ClothPlugins::default()))
        .insert_resource(TimeUpdateStrategy::ManualDuration(TICK));
    let cloth = spawn(&mut app, ());
    run(&mut app, 5);
    assert!(app.world().get::<ClothSurface>(cloth).is_none());
    assert!(app.world().get::<ClothState>(cloth).is_some_and(|state| state.fabric().is_some()));
}

#[test]
fn levels_look_to_cameras() {
    let mut app = app(TICK);
    run(&mut app, 1);
    assert!(
        app.world_mut()
            .query_filtered::<(), (With<Camera3d>, With<LodViewer>)>()
            .single(app.world())
            .is_ok()
    );
}

#[test]
fn gizmos_are_drawn_where_asked_for() {
    let mut app = app(TICK);
    app.add_plugins((GizmoPlugin, ClothDebugPlugin));
    let [cloth, _] = [0.0_f32, 0.5].map(|x| spawn(&mut app, Transform::from_xyz(x, 0.0, 0.0)));
    let drawn = |app: &mut App| {
        run(app, 3);
        let handles = app.world().resource::<GizmoHandles>().handles();
        handles.get(&core::any::TypeId::of::<ClothGizmos>()).is_some_and(Option::is_some)
    };
    assert!(!drawn(&mut app));
    app.world_mut().entity_mut(cloth).insert(ClothGizmos::ALL);
    assert!(drawn(&mut app));
    app.world_mut().entity_mut(cloth).remove::<ClothGizmos>();
    assert!(!drawn(&mut app));
    *app.world_mut().resource_mut::<GizmoConfigStore>().config_mut::<ClothGizmos>().1 =
        ClothGizmos::ALL;
    assert!(drawn(&mut app));
}

/// Prints what it costs to show a flag of 33 × 33 particles, without Bevy's upload of its mesh:
/// `cargo test --release -p bevy_bunting --features render --lib -- --ignored --nocapture cost`.
#[test]
#[ignore = "it measures"]
fn cost_of_a_visible_flag() {
    const FLAGS: usize = 64;
    const FRAMES: usize = 200;
    let mut app = app(TICK);
    let shape = ClothMesh::grid(33, 33, 1.5, 1.0);
    for _ in 0..FLAGS {
        let flag = spawn(&mut app, ());
        app.world_mut().entity_mut(flag).insert(shape.clone());
    }
    run(&mut app, 50);
    let mut durations = [const { Vec::new() }; 2];
    for _ in 0..FRAMES {
        run(&mut app, 1);
        let world = app.world_mut();
        for mut state in world.query::<&mut ClothState>().iter_mut(world) {
            state.set_changed();
        }
        for mut surface in world.query::<&mut ClothSurface>().iter_mut(world) {
            surface.positions.iter_mut().for_each(|position| *position *= 1.01);
        }
        let began = Instant::now();
        world.run_system_cached(super::bounds::bound_cloths).expect("cloths have bounds");
        let bounded = Instant::now();
        world.run_system_cached(super::write::write_visible).expect("cloths have meshes");
        durations[0].push(bounded - began);
        durations[1].push(bounded.elapsed());
    }
    for (what, mut durations) in ["bounds", "mesh"].into_iter().zip(durations) {
        durations.sort();
        let each = durations[FRAMES / 2].as_secs_f64() * 1e3 / FLAGS as f64;
        println!("{what}: {each:.5} ms a flag and frame");
    }
}

/// A mesh that is no grid goes through its levels, and wears the mesh of each.
#[test]
fn any_mesh_has_a_mesh_for_each_level() {
    let mut app = app(TICK);
    let grid = FabricBuilder::grid(Grid::new(13, 13, 1.0, 1.0)).build().expect("a square");
    let indices = grid.triangles().as_flattened().to_vec();
    let shape = ClothMesh::triangles(grid.rest_positions().to_vec(), indices, grid.uvs().to_vec());
    let levels = LodSet::new([10.0]).pinned_to(0);
    let attachment = Attachment::in_place(ClothEdge::Top);
    let cloth = app.world_mut().spawn((shape, attachment, levels)).id();
    run(&mut app, 10);
    assert_eq!(positions(&app, cloth).len(), 169);
    app.world_mut().get_mut::<LodSet>(cloth).expect("levels").pinned = Some(1);
    run(&mut app, 30);
    let count = positions(&app, cloth).len();
    assert!((48..120).contains(&count), "{count} vertices");
    assert!(is_current(&app, cloth));
    let Some(VertexAttributeValues::Float32x2(uv)) =
        mesh(&app, cloth).attribute(Mesh::ATTRIBUTE_UV_0)
    else {
        panic!("the finest has texture coordinates")
    };
    assert_eq!((uv[0], uv[count - 1]), ([0.0, 0.0], [1.0, 1.0]));
    app.world_mut().get_mut::<LodSet>(cloth).expect("levels").pinned = Some(0);
    run(&mut app, 30);
    assert_eq!(positions(&app, cloth).len(), 169);
    assert!(is_current(&app, cloth));
    // It blows in the wind as it did, neither torn nor crumpled.
    let state = app.world().get::<ClothState>(cloth).expect("a state");
    for link in state.fabric().expect("a fabric").links() {
        let [a, b] = link.particles.map(|end| state.positions()[end as usize]);
        let stretch = a.distance(b) / link.rest_length;
        assert!((0.8..1.1).contains(&stretch), "{stretch}");
    }
}
