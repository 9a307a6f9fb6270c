//! The plugin that reads components from glTF files.

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;
use bevy_world_serialization::WorldInstanceReady;

use crate::gltf::components::insert_components;

/// Inserts the components that an artist has written into the `extras` of a glTF file's scene, nodes, meshes and
/// materials (custom properties in Blender) as soon as a scene of it is spawned by `WorldAssetRoot`.
///
/// # Form
///
/// The form is that of [skein](https://github.com/rust-adventure/skein) for Bevy 0.19, a list of components under the key
/// `skein`, each as Bevy's reflection writes it in JSON:
///
/// ```json
/// "extras": {"skein": [
///     {"ClothFromMesh": {"weights": {"paint": {"Color": "Red"}, "free": 0.0, "pinned": 1.0}}},
///     {"ClothMaterial": {"area_density": 0.15, "bend_stiffness": 2e-5}},
///     {"Attachment": {"target": "Pole", "vertices": {"Edge": "Left"}}}
/// ]}
/// ```
///
/// In addition,
/// - the name of a type suffices where skein needs its whole path,
/// - a field that is an entity holds the name of a node of the same scene, or of a mesh if no node has the name, as
///   `Name` has it on the entity,
/// - fields with defaults may be left out,
/// - resources, such as `ClothSettings`, may be given as well. They hold for the whole app.
///
/// The extras of nodes are inserted into the node's entity, those of meshes and materials into the entities below it that
/// have a `Mesh3d`: that is the place of `ClothFromMesh`.
///
/// Where `SkeinPlugin` is added, too, disable this plugin: both read the same lists. Skein cannot name entities.
///
/// # Errors
///
/// [`GltfComponentFailed`](crate::GltfComponentFailed) names the file, the node and the key.
#[derive(Debug, Default)]
pub struct ClothGltfPlugin;

impl Plugin for ClothGltfPlugin {
    fn build(&self, app: &mut App) {
        app.add_observer(read_scene);
    }
}

/// Reads a scene's components when all of its entities are there.
fn read_scene(ready: On<WorldInstanceReady>, mut commands: Commands) {
    let scene = ready.entity;
    commands.queue(move |world: &mut World| insert_components(world, scene));
}
