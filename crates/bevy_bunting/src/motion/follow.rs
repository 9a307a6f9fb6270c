//! Who has to be looked at because something has moved: most things rest, and cost nothing.

use bevy_ecs::entity::EntityHashSet;
use bevy_ecs::hierarchy::{ChildOf, Children};
use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemParam;
use bevy_transform::components::Transform;

use crate::motion::attachment::Attachment;

/// A cloth that is attached to another entity, and so moves with it.
#[derive(Component, Debug)]
#[relationship(relationship_target = Followers)]
pub(crate) struct Follows(Entity);

/// The cloths that are attached to an entity.
#[derive(Component, Debug)]
#[relationship_target(relationship = Follows)]
pub(crate) struct Followers(Vec<Entity>);

/// Notes what each cloth is attached to, where that is new.
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

/// Ends the following of what is attached no more.
pub(crate) fn end_following(released: On<Remove, Attachment>, mut commands: Commands) {
    commands.entity(released.entity).try_remove::<Follows>();
}

/// Finds out what does not stand where it stood when the system last ran.
#[derive(SystemParam)]
pub(crate) struct Motions<'w, 's> {
    transforms: Query<'w, 's, Entity, Changed<Transform>>,
    parents: Query<'w, 's, Entity, Changed<ChildOf>>,
    attachments: Query<'w, 's, Entity, Changed<Attachment>>,
    orphans: RemovedComponents<'w, 's, ChildOf>,
    released: RemovedComponents<'w, 's, Attachment>,
    hanging: Query<'w, 's, (Option<&'static Children>, Option<&'static Followers>)>,
    moved: Local<'s, EntityHashSet>,
    open: Local<'s, Vec<Entity>>,
}

impl Motions<'_, '_> {
    /// All that was moved or attached anew, these others, and all that hangs on any of them.
    pub fn find(&mut self, others: impl IntoIterator<Item = Entity>) -> &EntityHashSet {
        self.moved.clear();
        self.open.extend(others);
        self.open.extend(&self.transforms);
        self.open.extend(&self.parents);
        self.open.extend(&self.attachments);
        self.open.extend(self.orphans.read());
        self.open.extend(self.released.read());
        while let Some(entity) = self.open.pop() {
            if self.moved.insert(entity)
                && let Ok((children, followers)) = self.hanging.get(entity)
            {
                self.open.extend(children.into_iter().flat_map(|children| children.iter()));
                self.open.extend(followers.into_iter().flat_map(|followers| followers.iter()));
            }
        }
        &self.moved
    }
}
