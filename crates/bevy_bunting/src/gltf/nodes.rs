//! The nodes of a scene by their names.

use bevy_ecs::prelude::*;
use bevy_mesh::Mesh3d;
use bevy_platform::collections::HashMap;

/// The nodes of a scene by their names, and its meshes by theirs where no node has the name. None for a name that
/// several have.
#[derive(Debug, Default)]
pub struct Nodes(HashMap<String, Option<Entity>>);

impl Nodes {
    /// The nodes among these entities.
    pub fn of(world: &World, entities: &[Entity]) -> Self {
        let mut nodes = Self::default();
        for is_mesh in [false, true] {
            let mut found: HashMap<String, Option<Entity>> = HashMap::default();
            for &entity in entities {
                let Some(name) = world.get::<Name>(entity) else { continue };
                if world.entity(entity).contains::<Mesh3d>() == is_mesh {
                    found
                        .entry(name.to_string())
                        .and_modify(|it| *it = None)
                        .or_insert(Some(entity));
                }
            }
            for (name, entity) in found {
                nodes.0.entry(name).or_insert(entity);
            }
        }
        nodes
    }

    /// The entity of a name.
    ///
    /// # Errors
    ///
    /// No node has the name, or several have it.
    pub fn find(&self, name: &str) -> Result<Entity, String> {
        match self.0.get(name) {
            Some(Some(entity)) => Ok(*entity),
            Some(None) => Err(format!("several nodes are named {name:?}")),
            None => Err(format!("no node is named {name:?}")),
        }
    }
}
