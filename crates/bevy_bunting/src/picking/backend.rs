//! The cloths under a pointer: rays against the surfaces that are shown.

use bevy_camera::Camera;
use bevy_camera::primitives::Aabb;
use bevy_ecs::prelude::*;
use bevy_math::{Ray3d, Vec3};
use bevy_picking::Pickable;
use bevy_picking::backend::ray::RayMap;
use bevy_picking::backend::{HitData, PointerHits};
use bevy_transform::components::GlobalTransform;
use bunting_solver::Fabric;
use parry3d::query::{Ray, RayCast};

use crate::cloth::state::ClothState;
use crate::display::surface::ClothSurface;
use crate::spatial::surface::Surface;

type PickedCloth = (
    Entity,
    &'static ClothState,
    Option<&'static ClothSurface>,
    &'static GlobalTransform,
    Option<&'static Aabb>,
    Option<&'static Pickable>,
);

/// A point of a cloth under a pointer.
#[derive(Clone, Copy, Debug)]
pub(super) struct ClothHit {
    /// Distance of the farthest corner of the triangle from the point, m.
    pub corners: f32,
    /// The point at rest, in the cloth's frame, m.
    pub at_rest: Vec3,
}

/// Finds the cloths under each pointer.
pub(super) fn find_cloths(
    rays: Res<RayMap>,
    cameras: Query<&Camera>,
    cloths: Query<PickedCloth>,
    mut hits: MessageWriter<PointerHits>,
) {
    for (id, &ray) in rays.iter() {
        let Ok(camera) = cameras.get(id.camera) else { continue };
        let mut picks = Vec::new();
        for (entity, state, surface, frame, bounds, pickable) in &cloths {
            let is_hoverable = pickable.is_none_or(|it| it.is_hoverable);
            let Some(fabric) = state.fabric().filter(|_| is_hoverable) else { continue };
            // The surface may still be that of another level.
            let shown = surface.filter(|surface| surface.level == state.level);
            let positions = shown.map_or(state.positions(), |surface| &surface.positions);
            if let Some(hit) = cast(ray, frame, fabric, positions, bounds) {
                let HitPoint { distance, at, normal, on_cloth } = hit;
                let (at, normal) = (Some(at), Some(normal));
                let data = HitData::new_with_extra(id.camera, distance, at, normal, on_cloth);
                picks.push((entity, data));
            }
        }
        if !picks.is_empty() {
            hits.write(PointerHits::new(id.pointer, picks, camera.order as f32));
        }
    }
}

/// The point where a ray meets a cloth.
struct HitPoint {
    /// Distance from the origin of the ray, m.
    distance: f32,
    /// In the world, m.
    at: Vec3,
    /// Unit normal in the world, towards the ray's origin.
    normal: Vec3,
    on_cloth: ClothHit,
}

/// The first point where a ray in the world meets a surface in its frame, whose bounds may be known.
fn cast(
    ray: Ray3d,
    frame: &GlobalTransform,
    fabric: &Fabric,
    positions: &[Vec3],
    bounds: Option<&Aabb>,
) -> Option<HitPoint> {
    let to_frame = frame.affine().inverse();
    let origin = to_frame.transform_point3(ray.origin);
    let in_frame = Ray::new(origin, to_frame.transform_vector3(*ray.direction));
    let is_beside = bounds.is_some_and(|bounds| {
        let (least, greatest) = (bounds.min().into(), bounds.max().into());
        !parry3d::bounding_volume::Aabb::new(least, greatest)
            .intersects_local_ray(&in_frame, f32::MAX)
    });
    if is_beside {
        return None;
    }
    let hit = Surface::new(fabric, positions)?.cast_ray(&in_frame, f32::MAX)?;
    let at_corners = |all: &[Vec3]| hit.particles.map(|particle| all[particle as usize]);
    let rest = at_corners(fabric.rest_positions());
    let corners = at_corners(positions).map(|corner| corner.distance(hit.at));
    Some(HitPoint {
        distance: hit.distance,
        at: ray.get_point(hit.distance),
        normal: frame.affine().transform_vector3(hit.normal).normalize_or_zero(),
        on_cloth: ClothHit {
            corners: corners.into_iter().fold(0.0, f32::max),
            at_rest: rest.into_iter().zip(hit.weights).map(|(at, weight)| at * weight).sum(),
        },
    })
}
