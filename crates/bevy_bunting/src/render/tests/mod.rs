//! Tests of rendering without a renderer: with assets, cameras and visibility only.

mod changed;
mod contact_gizmos;
mod cost;
mod deformer;
mod first_hour;
mod from_mesh;
mod from_skin;
mod given;
mod levels;
mod parts;
pub(crate) mod reflect;
mod resolution;
mod subdivided;
mod written;

use std::time::Duration;

use bevy_app::prelude::*;
use bevy_asset::{AssetEvent, AssetPlugin, Assets, Handle, RenderAssetUsages};
use bevy_camera::primitives::Aabb;
use bevy_camera::visibility::ViewVisibility;
use bevy_camera::{Camera3d, CameraPlugin};
use bevy_ecs::prelude::*;
use bevy_math::{Vec2, Vec3, Vec3A};
use bevy_mesh::{Mesh, Mesh3d, MeshPlugin, VertexAttributeValues};
use bevy_time::{TimePlugin, TimeUpdateStrategy};
use bevy_transform::prelude::*;

use crate::prelude::*;

const TICK: Duration = Duration::from_micros(15_625);

const FLAG: ClothMesh = ClothMesh::grid(9, 5, 1.5, 1.0);

/// Rounding error of a unit vector's component.
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

/// A flag that is drawn as it is simulated.
fn spawn(app: &mut App, more: impl Bundle) -> Entity {
    let none = ClothSubdivision::NONE;
    app.world_mut().spawn((FLAG, Attachment::in_place(ClothEdge::Left), none, more)).id()
}

fn run(app: &mut App, updates: usize) {
    (0..updates).for_each(|_| app.update());
}

fn add(app: &mut App, mesh: Mesh) -> Mesh3d {
    Mesh3d(app.world_mut().resource_mut::<Assets<Mesh>>().add(mesh))
}

/// The flag's mesh, which tests give to a cloth.
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

/// Whether each vertex is drawn where the surface has it.
fn is_current(app: &App, cloth: Entity) -> bool {
    let surface = surface(app, cloth);
    let state = app.world().get::<ClothState>(cloth).expect("a cloth");
    let levels = state.levels.as_ref().expect("it is simulated");
    let (drawn, level) = (positions(app, cloth), surface.level());
    let vertices = &levels.topology(level).vertices;
    let place = |vertex: u32| levels.vertex_position(level, vertex, &surface.positions);
    let mut pairs = vertices.iter().zip(drawn);
    drawn.len() == vertices.len()
        && pairs.all(|(&vertex, at)| place(vertex).is_none_or(|place| place.to_array() == *at))
}

fn failures(app: &App) -> &[ClothError] {
    &app.world().resource::<Failures>().0
}

fn modified(app: &mut App) -> usize {
    let mut events = app.world_mut().resource_mut::<Messages<AssetEvent<Mesh>>>();
    events.drain().filter(|event| matches!(event, AssetEvent::Modified { .. })).count()
}
