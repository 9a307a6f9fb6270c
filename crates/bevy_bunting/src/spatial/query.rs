//! The system parameter that finds cloths by rays, points and shapes.

use bevy_ecs::change_detection::Tick;
use bevy_ecs::entity::EntityHashMap;
use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemParam;
use bevy_math::{Isometry3d, Ray3d, Vec3};
use parry3d::bounding_volume::Aabb;
use parry3d::query::{PointQuery, Ray, RayCast};
use parry3d::shape::Shape;

use crate::cloth::state::ClothState;
use crate::motion::growth::SizedFrame;
use crate::motion::pose::{PoseHistory, parry_pose};
use crate::spatial::surface::{PointOnSurface, Surface, meet};

/// A point on the surface of a cloth. All vectors are in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClothHit {
    /// The cloth.
    pub entity: Entity,
    /// Distance from the ray's origin, or from the point that this one is nearest to, m.
    pub distance: f32,
    /// The point, m.
    pub point: Vec3,
    /// Unit normal of the triangle there: of a ray's hit towards the ray's origin, of a nearest point to the front; zero on a
    /// triangle without area.
    pub normal: Vec3,
    /// The particles at the corners of this triangle, numbered as in [`ClothState::positions`].
    pub particles: [u32; 3],
    /// Weights of these particles at the point: from 0 to 1, with the sum 1.
    pub weights: [f32; 3],
}

/// Finds cloths by rays, points and shapes, on their surfaces after the last tick: a system parameter for hits on a server,
/// for the AI, for sounds. It needs neither pointers nor a window, and no cloth wakes.
///
/// The surface is that of the triangles between particles, at the level of detail that the cloth has, in its frame at the end
/// of the last tick. Rigid triangles, of weight 0, have no particles and are not found; cloths that are paused or asleep are.
/// Each call compares boxes, which are made once a tick, with all cloths, and then all triangles of those that are near: some
/// microseconds for a cloth of a thousand particles. Of points at the same distance the first found counts.
///
/// ```
/// use bevy_bunting::ClothSpatialQuery;
/// use bevy_bunting::prelude::*;
/// use bevy_ecs::prelude::*;
/// use bevy_math::{Dir3, Ray3d, Vec3};
///
/// /// A bullet pushes the first cloth in its way.
/// fn shoot(mut space: ClothSpatialQuery, mut commands: Commands) {
///     let ray = Ray3d::new(Vec3::Y, Dir3::X);
///     if let Some(hit) = space.cast_ray(ray, 100.0, |_| true) {
///         commands.trigger(ClothImpulse::momentum(hit.point, 0.1, 0.01 * Vec3::X).on(hit.entity));
///     }
/// }
/// # bevy_ecs::system::assert_is_system(shoot);
/// ```
#[derive(SystemParam)]
pub struct ClothSpatialQuery<'w, 's> {
    cloths: Query<'w, 's, (Entity, Ref<'static, ClothState>, &'static PoseHistory)>,
    /// Boxes in the cloths' frames, with the ticks of change that they were made in.
    bounds: Local<'s, EntityHashMap<(Tick, Option<Aabb>)>>,
}

/// A cloth that may be found.
struct Found<'a> {
    entity: Entity,
    surface: Surface<'a>,
    /// Box around the particles in the frame.
    bounds: Aabb,
    frame: SizedFrame,
}

impl ClothSpatialQuery<'_, '_> {
    /// The first point where a ray meets a cloth that `is_meant`, at most `max_distance` metres away. None if a number is not
    /// finite.
    pub fn cast_ray(
        &mut self,
        ray: Ray3d,
        max_distance: f32,
        is_meant: impl Fn(Entity) -> bool,
    ) -> Option<ClothHit> {
        let mut first: Option<ClothHit> = None;
        self.for_each(is_meant, |cloth| {
            let within = first.map_or(max_distance, |hit| hit.distance);
            let SizedFrame { pose, size } = cloth.frame;
            let direction = pose.rotation.inverse() * *ray.direction / size;
            let ray = Ray::new(cloth.frame.to_local(ray.origin), direction);
            if cloth.bounds.intersects_local_ray(&ray, within)
                && let Some(hit) = cloth.surface.cast_ray(&ray, within)
                && first.is_none_or(|former| hit.distance < former.distance)
            {
                first = Some(cloth.in_world(hit));
            }
        });
        first
    }

    /// The nearest point, to a place in the world (m), of a cloth that `is_meant`, at most `max_distance` metres away. None if
    /// a number is not finite.
    pub fn nearest_point(
        &mut self,
        to: Vec3,
        max_distance: f32,
        is_meant: impl Fn(Entity) -> bool,
    ) -> Option<ClothHit> {
        let mut nearest: Option<ClothHit> = None;
        self.for_each(is_meant, |cloth| {
            let size = cloth.frame.size;
            let within = nearest.map_or(max_distance, |hit| hit.distance) / size;
            let to = cloth.frame.to_local(to);
            if cloth.bounds.distance_to_local_point(to, true) <= within
                && let Some(hit) = cloth.surface.nearest_point(to, within)
                && let hit = (PointOnSurface { distance: size * hit.distance, ..hit })
                && nearest.is_none_or(|former| hit.distance < former.distance)
            {
                nearest = Some(cloth.in_world(hit));
            }
        });
        nearest
    }

    /// The cloths that `is_meant` whose surface a shape with a pose in the world (m) intersects, as that of a
    /// [`ClothCollider`](crate::ClothCollider). A solid shape intersects a cloth within it.
    pub fn overlapping(
        &mut self,
        shape: &dyn Shape,
        pose: Isometry3d,
        is_meant: impl Fn(Entity) -> bool,
    ) -> Vec<Entity> {
        let mut found = Vec::new();
        self.for_each(is_meant, |cloth| {
            let SizedFrame { pose: frame, size } = cloth.frame;
            let mut pose = frame.inverse() * pose;
            let small;
            let mut shape = shape;
            if size != 1.0 {
                pose.translation /= size;
                // A shape that parry cannot scale is found nowhere.
                let scaled = shape.scale_dyn(Vec3::splat(size.recip()), 0);
                let Some(scaled) = scaled else { return };
                small = scaled;
                shape = &*small;
            }
            if meet(&cloth.bounds, &shape.compute_aabb(&parry_pose(pose)))
                && cloth.surface.overlaps(shape, pose)
            {
                found.push(cloth.entity);
            }
        });
        found
    }

    /// Calls `look` with each cloth that `is_meant` and has a surface.
    fn for_each(&mut self, is_meant: impl Fn(Entity) -> bool, mut look: impl FnMut(&Found)) {
        let cloths = self.cloths.iter().filter(|(_, _, frame)| frame.is_observed());
        for (entity, state, frame) in cloths.filter(|(entity, ..)| is_meant(*entity)) {
            let Some(fabric) = state.fabric() else { continue };
            let Some(surface) = Surface::new(fabric, state.positions()) else { continue };
            let changed = state.last_changed();
            let bounds = self.bounds.entry(entity).or_insert((changed, None));
            if bounds.0 != changed || bounds.1.is_none() {
                *bounds = (changed, Surface::bounds(state.positions()));
            }
            if let Some(bounds) = bounds.1 {
                look(&Found {
                    entity,
                    surface,
                    bounds,
                    frame: SizedFrame { pose: frame.end(), size: state.scale() },
                });
            }
        }
        // Boxes of cloths that are gone.
        if self.bounds.len() > 2 * self.cloths.iter().len() {
            self.bounds.retain(|entity, _| self.cloths.contains(*entity));
        }
    }
}

impl Found<'_> {
    fn in_world(&self, hit: PointOnSurface) -> ClothHit {
        ClothHit {
            entity: self.entity,
            distance: hit.distance,
            point: self.frame.to_world(hit.at),
            normal: self.frame.pose.rotation * hit.normal,
            particles: hit.particles,
            weights: hit.weights,
        }
    }
}
