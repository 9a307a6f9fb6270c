//! The bounding boxes of cloths, by which Bevy culls them.

use bevy_camera::primitives::Aabb;
use bevy_camera::visibility::NoAutoAabb;
use bevy_ecs::prelude::*;
use bevy_math::Vec3A;

use crate::cloth::state::ClothState;
use crate::display::easing::ClothEasing;
use crate::fabric::levels::ClothLevels;
use crate::render::deformer::Carried;
use crate::render::level_meshes::LevelMeshes;
use crate::render::subdivide::edge_length;

type BoundedCloth = (
    &'static ClothState,
    Option<&'static ClothEasing>,
    Option<&'static LevelMeshes>,
    Option<&'static Carried>,
    &'static mut Aabb,
);
type IsStale =
    Or<(Changed<ClothState>, Changed<ClothEasing>, Changed<LevelMeshes>, Changed<Carried>)>;

/// Length of an edge that the drawn surface may lie beyond the box of the particles: the negative weights at the middle of
/// a cell add up to 0.28, and its sixteen particles are at most three diagonals apart.
const BEYOND: f32 = 1.2;

/// Distance by which a smooth surface, or a mesh that follows particles, may lie beyond the box of the particles, m.
fn beyond_particles(levels: &ClothLevels) -> f32 {
    // The coarsest level has the longest edges between particles, and a mesh that follows may have longer ones.
    let coarsest = levels.count() - 1;
    let fabric = levels.fabric(coarsest);
    let of_particles = (2.0 * fabric.area() / fabric.triangles().len().max(1) as f32).sqrt();
    BEYOND * of_particles.max(edge_length(levels, coarsest))
}

/// Bounds the rigid part and the surfaces before and after the last tick, between which the shown surface
/// lies. Cloths that are not visible are bounded, too, as they may come into view.
pub fn bound_cloths(mut cloths: Query<BoundedCloth, (With<NoAutoAabb>, IsStale)>) {
    for (state, easing, level_meshes, carried, mut bounds) in &mut cloths {
        let levels = level_meshes.map(|it| &*it.levels).or(carried.and_then(Carried::levels));
        let smooth = carried.is_some()
            || level_meshes.is_some_and(|it| it.halvings > 0 || it.levels.carried(0).is_some());
        let [from, to] = match easing {
            Some(easing) if easing.level().is_some() => {
                [&*easing.previous_positions, &*easing.positions]
            }
            _ => [state.previous_positions(), state.positions()],
        };
        let particles = from.iter().chain(to);
        let rigid = levels.and_then(|it| it.rigid().bounds.as_ref());
        let (low, high) = particles
            .chain(rigid.into_iter().flatten())
            .map(|&position| Vec3A::from(position))
            .fold((Vec3A::INFINITY, Vec3A::NEG_INFINITY), |(low, high), position| {
                (low.min(position), high.max(position))
            });
        if low.cmple(high).all() {
            let beyond = levels.filter(|_| smooth).map_or(0.0, beyond_particles);
            let beyond = beyond + carried.map_or(0.0, Carried::reach);
            let half_extents = 0.5 * (high - low) + Vec3A::splat(beyond);
            let bound = Aabb { center: 0.5 * (low + high), half_extents };
            bounds.set_if_neq(bound);
        }
    }
}
