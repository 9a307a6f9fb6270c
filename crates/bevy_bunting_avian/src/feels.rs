//! Bodies that feel cloth.

use avian3d::prelude::{RigidBody, RigidBodyColliders};
use bevy_bunting::{AnchorReactions, Attachment, ClothCollider, ClothReactions};
use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemParam;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;

use crate::former_reaction::FormerReaction;

/// Cloth pushes and pulls this avian rigid body: insert this component beside its `RigidBody`. Without it, cloth follows
/// the body, and the body does not feel it.
///
/// The colliders of the body get [`ClothReactions`], and cloths that are attached to the body or to a descendant of it get
/// [`AnchorReactions`]; both may be read, and stay when this component is removed. The body gets their mean forces over the
/// last tick, as forces that also wake it.
///
/// A force comes a tick late. So a body must be heavier than the cloth that hangs on it: otherwise it is swung ever further.
/// The push of cloth that touches a body is limited, so that cloth carries a body and slows it, but throws it back with at most
/// 0.3 of the speed at which it came; cloth that itself moves up faster than that does not lift it.
///
/// ```
/// use avian3d::prelude::RigidBody;
/// use bevy_bunting_avian::FeelsCloth;
/// use bevy_ecs::prelude::*;
///
/// let mut world = World::new();
/// // A boat that its sail pulls.
/// world.spawn((RigidBody::Dynamic, FeelsCloth::default()));
/// ```
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq, Reflect)]
#[type_path = "bevy_bunting_avian"]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[require(RigidBody)]
pub struct FeelsCloth {
    /// Whether the body feels cloth that touches its colliders.
    pub contacts: bool,
    /// Whether the body feels cloth that is attached to it.
    pub anchors: bool,
}

impl Default for FeelsCloth {
    /// The body feels both.
    fn default() -> Self {
        Self { contacts: true, anchors: true }
    }
}

/// Finds the bodies that feel the pull of attached cloth.
#[derive(SystemParam)]
pub(crate) struct Carriers<'w, 's> {
    bodies: Query<'w, 's, &'static FeelsCloth>,
    parents: Query<'w, 's, &'static ChildOf>,
}

impl Carriers<'_, '_> {
    /// The body that feels what pulls at `target`: the nearest of it and its ancestors that has a [`FeelsCloth`].
    pub fn of(&self, target: Entity) -> Option<Entity> {
        let ancestors = self.parents.iter_ancestors(target);
        let body =
            core::iter::once(target).chain(ancestors).find(|&it| self.bodies.contains(it))?;
        self.bodies.get(body).is_ok_and(|feels| feels.anchors).then_some(body)
    }
}

/// The entity on which an [`Attachment`] holds a cloth.
pub(crate) fn target_of(cloth: Entity, attachment: &Attachment) -> Entity {
    if attachment.target == Entity::PLACEHOLDER { cloth } else { attachment.target }
}

/// Asks for the reactions of the colliders of bodies that feel contacts.
pub(crate) fn ask_for_contacts(
    bodies: Query<(&FeelsCloth, &RigidBodyColliders)>,
    colliders: Query<(), (With<ClothCollider>, Without<FormerReaction>)>,
    mut commands: Commands,
) {
    for (_, of_body) in bodies.iter().filter(|(feels, _)| feels.contacts) {
        for collider in of_body.iter().filter(|&it| colliders.contains(it)) {
            commands
                .entity(collider)
                .insert((ClothReactions::default(), FormerReaction::default()));
        }
    }
}

/// Asks for the reactions of the anchors on bodies that feel them.
pub(crate) fn ask_for_anchors(
    cloths: Query<(Entity, &Attachment), Without<AnchorReactions>>,
    carriers: Carriers,
    mut commands: Commands,
) {
    if carriers.bodies.is_empty() {
        return;
    }
    for (cloth, attachment) in &cloths {
        let anchors = attachment.anchors.iter().map(|anchor| anchor.target);
        let mut targets = anchors.chain([target_of(cloth, attachment)]);
        if targets.any(|target| carriers.of(target).is_some()) {
            commands.entity(cloth).insert(AnchorReactions::default());
        }
    }
}
