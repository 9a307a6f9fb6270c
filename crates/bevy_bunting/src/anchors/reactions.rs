//! Forces and torques of anchors.

use std::sync::Arc;

use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bunting_solver::PinGroups;

use crate::fabric::known_level::KnownLevel;
use crate::fabric::levels::ClothLevels;
use crate::motion::held_group::HeldGroup;

/// What a cloth does to that which holds it: insert this component beside its [`Attachment`](crate::Attachment), and read
/// it after each tick. Cloths without it cost nothing for it.
///
/// A reaction is the tension of the cloth, and the weight, drag and inertia of the held vertices themselves. Its mean over
/// the tick is what a rigid body that carries the cloth needs. A cloth that sleeps at rest does what it did before it
/// fell asleep; after a change of level or of the attachment, inertia of the held vertices is missing for a tick.
///
/// ```
/// use bevy_bunting::prelude::*;
/// use bevy_ecs::prelude::*;
///
/// let mut world = World::new();
/// let flag = ClothMesh::grid(17, 17, 1.0, 1.0);
/// let held = Attachment::in_place(ClothEdge::Left);
/// let flag = world.spawn((flag, held, AnchorReactions::default())).id();
/// // After a tick, the force on the pole, N.
/// let force = world.get::<AnchorReactions>(flag).unwrap().target.force;
/// # assert_eq!(force.length(), 0.0);
/// ```
#[derive(Component, Clone, Debug, Default, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[require(PinReporting)]
pub struct AnchorReactions {
    /// The reaction on the target of the attachment; on the cloth's own transform, if it has none.
    pub target: AnchorReaction,
    /// The reaction on each of [`Attachment::anchors`](crate::Attachment::anchors).
    pub anchors: Vec<AnchorReaction>,
}

/// What a cloth does to one entity that holds it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct AnchorReaction {
    /// Mean force over the last tick, N, in the world.
    pub force: Vec3,
    /// Mean torque over the last tick, N·m, in the world, about the place of the mesh's origin: the target's pose times the
    /// offset.
    pub torque: Vec3,
}

/// The pins whose reactions are wanted, at the cloth's present level.
#[derive(Component, Debug, Default)]
pub(crate) struct PinReporting {
    /// The levels and the level that the groups are those of.
    of: Option<KnownLevel>,
    pub groups: Option<Arc<PinGroups>>,
}

impl PinReporting {
    /// Whether the groups are those of a level.
    pub fn fits(&self, levels: &Arc<ClothLevels>, level: usize) -> bool {
        self.of.as_ref().is_some_and(|of| of.is(levels, level))
    }

    /// Finds the groups of a level, given what is held on each target.
    pub fn find(&mut self, levels: &Arc<ClothLevels>, level: usize, held: &[HeldGroup]) {
        let mut groups = vec![Vec::new(); held.len()];
        for of_level in levels.held(level, held) {
            groups[of_level.group()].push(of_level.particle as u32);
        }
        self.groups = Some(Arc::new(PinGroups::new(levels.fabric(level), &groups)));
        self.of = Some(KnownLevel::new(levels, level));
    }
}
