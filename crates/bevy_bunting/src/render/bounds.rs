//! Keeps cloth from being culled while it could be seen.

use bevy_camera::primitives::Aabb;
use bevy_camera::visibility::NoAutoAabb;
use bevy_ecs::prelude::*;
use bevy_math::Vec3A;

use super::assign_meshes::LevelMeshes;
use crate::cloth::state::ClothState;
use crate::display::easing::ClothEasing;

type Bounded = (
    &'static ClothState,
    Option<&'static ClothEasing>,
    Option<&'static LevelMeshes>,
    &'static mut Aabb,
);
type IsStale = Or<(Changed<ClothState>, Changed<ClothEasing>, Changed<LevelMeshes>)>;

/// Bounds everything between the last two ticks, for cloths that are visible and for those that
/// may come into view.
pub fn bound_cloths(mut cloths: Query<Bounded, (With<NoAutoAabb>, IsStale)>) {
    for (state, easing, dress, mut bounds) in &mut cloths {
        let [from, to] = match easing {
            Some(easing) if easing.level().is_some() => {
                [&*easing.previous_positions, &*easing.positions]
            }
            _ => [state.previous_positions(), state.positions()],
        };
        let particles = from.iter().chain(to);
        let rigid = dress.and_then(|dress| dress.levels.rigid().bounds.as_ref());
        let (low, high) = particles
            .chain(rigid.into_iter().flatten())
            .map(|&position| Vec3A::from(position))
            .fold((Vec3A::INFINITY, Vec3A::NEG_INFINITY), |(low, high), position| {
                (low.min(position), high.max(position))
            });
        if low.cmple(high).all() {
            let bound = Aabb { center: 0.5 * (low + high), half_extents: 0.5 * (high - low) };
            bounds.set_if_neq(bound);
        }
    }
}
