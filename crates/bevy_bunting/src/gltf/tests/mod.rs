//! Tests of import from glTF files, without a renderer.

mod bad;
mod forms;
mod import;

use std::path::Path;
use std::time::Duration;

use bevy_app::{App, TaskPoolPlugin};
use bevy_asset::{AssetPlugin, AssetServer};
use bevy_camera::CameraPlugin;
use bevy_camera::primitives::Aabb;
use bevy_camera::visibility::{
    DynamicSkinnedMeshBounds, InheritedVisibility, ViewVisibility, Visibility, VisibilityClass,
};
use bevy_ecs::prelude::*;
use bevy_gltf::{
    GltfExtras, GltfLoaderSettings, GltfMaterialExtras, GltfMaterialName, GltfMeshExtras,
    GltfMeshName, GltfPlugin, GltfSceneExtras, GltfSceneName,
};
use bevy_math::Vec3;
use bevy_mesh::skinning::SkinnedMesh;
use bevy_mesh::{Mesh3d, MeshPlugin, MeshVertexAttribute, VertexFormat};
use bevy_time::{TimePlugin, TimeUpdateStrategy};
use bevy_transform::prelude::*;
use bevy_world_serialization::{WorldAssetRoot, WorldSerializationPlugin};

use crate::GltfComponentFailed;
use crate::prelude::*;

const TICK: Duration = Duration::from_micros(15_625);

/// Longest time that a file may take to load, s.
const PATIENCE: f32 = 20.0;

const PIN: MeshVertexAttribute = MeshVertexAttribute::new("Pin", 77_001, VertexFormat::Float32);
const PLAY: MeshVertexAttribute = MeshVertexAttribute::new("Play", 77_002, VertexFormat::Float32);

/// Messages of all failures.
#[derive(Resource, Default)]
struct Messages(Vec<String>);

/// An app that loads files of a folder. Types are registered by hand, which Bevy's feature `reflect_auto_register` does in
/// an app.
fn app(assets: &Path) -> App {
    let mut app = App::new();
    // `_PIN` and `_PLAY` in the file: Bevy looks them up without the underscore.
    let gltf = GltfPlugin::default()
        .add_custom_vertex_attribute("PIN", PIN)
        .add_custom_vertex_attribute("PLAY", PLAY);
    let file_path = assets.to_str().expect("a path").to_owned();
    app.add_plugins((TaskPoolPlugin::default(), TimePlugin, TransformPlugin))
        .add_plugins((AssetPlugin { file_path, ..AssetPlugin::default() }, MeshPlugin))
        .add_plugins((CameraPlugin, WorldSerializationPlugin, gltf, ClothPlugins::default()))
        .insert_resource(TimeUpdateStrategy::ManualDuration(TICK))
        .init_resource::<Messages>()
        .add_observer(|failed: On<ClothFailed>, mut commands: Commands| {
            let failed = *failed;
            commands.queue(move |world: &mut World| note(world, failed.message(world)));
        })
        .add_observer(|failed: On<GltfComponentFailed>, mut commands: Commands| {
            let failed = failed.clone();
            commands.queue(move |world: &mut World| note(world, failed.message(world)));
        })
        .register_type::<(Transform, GlobalTransform, TransformTreeChanged, Mesh3d, SkinnedMesh)>()
        .register_type::<(Visibility, InheritedVisibility, ViewVisibility, VisibilityClass)>()
        .register_type::<(Aabb, DynamicSkinnedMeshBounds, Name, ChildOf, Children)>()
        .register_type::<(GltfExtras, GltfMeshExtras, GltfMaterialExtras, GltfSceneExtras)>()
        .register_type::<(GltfMeshName, GltfMaterialName, GltfSceneName)>();
    app.finish();
    app.cleanup();
    app
}

fn note(world: &mut World, message: String) {
    world.resource_mut::<Messages>().0.push(message);
}

/// The folder of the project's own assets.
fn assets() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets")
}

/// Animations are assets of a plugin that these apps do without, and Bevy loads them where a package of the build asks for them.
fn without_animations(settings: &mut GltfLoaderSettings) {
    settings.load_animations = false;
}

/// Spawns the scene of a file, and updates until something with a name is there.
fn spawn(app: &mut App, file: &str, name: &str) -> Entity {
    let loads = app.world().resource::<AssetServer>().load_builder();
    let scene = loads.with_settings(without_animations).load(format!("{file}#Scene0"));
    app.world_mut().spawn((WorldAssetRoot(scene), Transform::default(), Visibility::default()));
    let start = std::time::Instant::now();
    loop {
        app.update();
        if let Some(found) = find(app, name) {
            app.update();
            return found;
        }
        assert!(start.elapsed().as_secs_f32() < PATIENCE, "{file} has not been loaded");
        std::thread::sleep(Duration::from_millis(1));
    }
}

fn find(app: &mut App, name: &str) -> Option<Entity> {
    let mut named = app.world_mut().query::<(Entity, &Name)>();
    named.iter(app.world()).find(|(_, it)| it.as_str() == name).map(|(entity, _)| entity)
}

/// The vertices of a cloth of a file at rest.
fn rest(app: &App, cloth: Entity) -> Vec<Vec3> {
    match app.world().get(cloth) {
        Some(ClothMesh::Triangles { positions, .. }) => positions.clone(),
        other => panic!("{other:?}"),
    }
}

fn run(app: &mut App, updates: usize) {
    (0..updates).for_each(|_| app.update());
}

fn messages(app: &App) -> &[String] {
    &app.world().resource::<Messages>().0
}
