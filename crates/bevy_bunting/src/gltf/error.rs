//! Reasons why a component of a glTF file cannot be used.

use bevy_ecs::prelude::*;

use crate::cloth::place::place;

/// A component in the `extras` of a glTF file cannot be used. Triggered and logged once for each instance of the scene;
/// the other components are inserted.
#[derive(EntityEvent, Clone, Debug)]
pub struct GltfComponentFailed {
    /// The entity of the node, mesh or scene with the extras.
    pub entity: Entity,
    /// The reason.
    pub error: GltfComponentError,
}

/// Reason why a component in the `extras` of a glTF file cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum GltfComponentError {
    /// The extras are not as expected.
    #[error(
        "its extras must have the form {{\"skein\": [{{\"ClothMaterial\": {{…}}}}, …]}}: {reason}"
    )]
    Form {
        /// What was found.
        reason: String,
    },
    /// No component or resource of this name is registered.
    #[error(
        "there is no component {component}: write the name or the whole path of a registered type that reflects Component or Resource"
    )]
    Unknown {
        /// The name in the file.
        component: String,
    },
    /// A value does not fit, or lacks a field that has no default.
    #[error("{component}, at {key}: {reason}")]
    Value {
        /// The name of the component in the file.
        component: String,
        /// Path of the value within the component, such as `anchors[0].target`; `.` is the component itself.
        key: String,
        /// What is wrong with it.
        reason: String,
    },
}

impl GltfComponentFailed {
    /// Logs the error and triggers the event.
    pub(super) fn report(world: &mut World, entity: Entity, error: GltfComponentError) {
        let failed = Self { entity, error };
        log::error!("{}", failed.message(world));
        world.trigger(failed);
    }

    /// The error's message as it is logged: after the file and the names of the node and of all above it.
    #[must_use]
    pub fn message(&self, world: &World) -> String {
        format!("{}{}", place(world, self.entity), self.error)
    }
}
