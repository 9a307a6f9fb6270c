//! Wind, gravity and colliders: everything that acts on a cloth besides its attachment.

pub(crate) mod cloth_collision;
pub mod collider;
pub(crate) mod collider_tree;
pub mod drive;
pub mod drive_colliders;
pub mod drive_pressures;
pub mod drive_self_collisions;
mod falloff;
pub mod forces;
pub mod group_cloths;
pub(crate) mod layers;
pub(crate) mod pressure;
pub(crate) mod reactions;
pub mod report_colliders;
mod scale_shapes;
pub(crate) mod scaled_shape;
pub(crate) mod self_collision;
mod shapes_in_units;
pub(crate) mod sum_reactions;
pub(crate) mod surroundings;
pub mod wind;
