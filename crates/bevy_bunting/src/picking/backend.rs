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
use parry3d::shape::Triangle;

use crate::cloth::state::ClothState;
use crate::display::surface::ClothSurface;

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
    if is_beside || positions.len() != fabric.particle_count() {
        return None;
    }
    let mut nearest: Option<(f32, Vec3, [u32; 3])> = None;
    for &particles in fabric.triangles() {
        let [a, b, c] = particles.map(|particle| positions[particle as usize]);
        let farthest = nearest.map_or(f32::MAX, |(distance, ..)| distance);
        let triangle = Triangle::new(a, b, c);
        if let Some(hit) = triangle.cast_local_ray_and_get_normal(&in_frame, farthest, false) {
            nearest = Some((hit.time_of_impact, hit.normal, particles));
        }
    }
    let (distance, normal, particles) = nearest?;
    Some(HitPoint {
        distance,
        at: ray.get_point(distance),
        normal: frame.affine().transform_vector3(normal).normalize_or_zero(),
        on_cloth: on_triangle(in_frame.point_at(distance), particles, fabric, positions),
    })
}

/// A point on a triangle of a cloth, which has an area: a ray has met it.
fn on_triangle(at: Vec3, particles: [u32; 3], fabric: &Fabric, positions: &[Vec3]) -> ClothHit {
    let [a, b, c] = particles.map(|particle| positions[particle as usize]);
    let rest = particles.map(|particle| fabric.rest_positions()[particle as usize]);
    let normal = (b - a).cross(c - a);
    let part = |from: Vec3, to: Vec3| (from - at).cross(to - at).dot(normal);
    let at_rest = part(b, c) * rest[0] + part(c, a) * rest[1] + part(a, b) * rest[2];
    let corners = [a, b, c].map(|corner| corner.distance(at)).into_iter().fold(0.0, f32::max);
    ClothHit { corners, at_rest: at_rest / normal.length_squared() }
}
