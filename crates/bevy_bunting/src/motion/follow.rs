//! Finds the entities that have moved with another one, by hierarchy or by attachment. Only moved entities
//! are visited, so that entities at rest cost nothing.

use bevy_ecs::entity::EntityHashSet;
use bevy_ecs::hierarchy::{ChildOf, Children};
use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemParam;
use bevy_transform::components::Transform;

use crate::motion::attachment::Attachment;

/// The target of a cloth's [`Attachment`], as a relationship: the cloth moves with it.
#[derive(Component, Debug)]
#[relationship(relationship_target = Followers)]
pub(crate) struct Follows(Entity);

/// The cloths that are attached to an entity.
#[derive(Component, Debug)]
#[relationship_target(relationship = Follows)]
pub(crate) struct Followers(Vec<Entity>);

/// Keeps [`Follows`] equal to the targets of changed attachments.
pub(crate) fn follow_targets(
    attachments: Query<(Entity, &Attachment), Changed<Attachment>>,
    targets: Query<()>,
    mut commands: Commands,
) {
    for (entity, attachment) in &attachments {
        match attachment.target_other_than(entity) {
            Some(target) if targets.contains(target) => {
                commands.entity(entity).insert(Follows(target));
            }
            _ => {
                commands.entity(entity).remove::<Follows>();
            }
        }
    }
}

/// Removes [`Follows`] when the attachment is removed.
pub(crate) fn stop_following(removed: On<Remove, Attachment>, mut commands: Commands) {
    commands.entity(removed.entity).try_remove::<Follows>();
}

/// Finds the entities that may have moved since the system last ran.
#[derive(SystemParam)]
pub(crate) struct MovedEntities<'w, 's> {
    transforms: Query<'w, 's, Entity, Changed<Transform>>,
    parents: Query<'w, 's, Entity, Changed<ChildOf>>,
    attachments: Query<'w, 's, Entity, Changed<Attachment>>,
    orphans: RemovedComponents<'w, 's, ChildOf>,
    released: RemovedComponents<'w, 's, Attachment>,
    dependents: Query<'w, 's, (Option<&'static Children>, Option<&'static Followers>)>,
    moved: Local<'s, EntityHashSet>,
    stack: Local<'s, Vec<Entity>>,
}

impl MovedEntities<'_, '_> {
    /// Returns the entities whose transform, parent or attachment changed, the entities in `others`, and the
    /// descendants and followers of both.
    pub fn find(&mut self, others: impl IntoIterator<Item = Entity>) -> &EntityHashSet {
        self.moved.clear();
        self.stack.extend(others);
        self.stack.extend(&self.transforms);
        self.stack.extend(&self.parents);
        self.stack.extend(&self.attachments);
        self.stack.extend(self.orphans.read());
        self.stack.extend(self.released.read());
        while let Some(entity) = self.stack.pop() {
            if self.moved.insert(entity)
                && let Ok((children, followers)) = self.dependents.get(entity)
            {
                self.stack.extend(children.into_iter().flat_map(|children| children.iter()));
                self.stack.extend(followers.into_iter().flat_map(|followers| followers.iter()));
            }
        }
        &self.moved
    }
}
