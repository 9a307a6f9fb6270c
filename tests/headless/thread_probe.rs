//! A collider that records the threads that solve contacts.

use std::collections::HashSet;
use std::sync::{Arc, Condvar, Mutex};
use std::thread::{self, ThreadId};
use std::time::Duration;

use bevy_math::Vec3;
use parry3d::bounding_volume::{Aabb, BoundingSphere};
use parry3d::mass_properties::MassProperties;
use parry3d::query::{PointProjection, PointQuery, Ray, RayCast, RayIntersection};
use parry3d::shape::{FeatureId, Shape, ShapeType, SharedShape, TypedShape};

/// Half extents of the bounding box, m: large enough that all cloth is a candidate for contacts.
const EXTENT: f32 = 100.0;

/// The nearest point of the shape to any other, m: so far away that no cloth touches it.
const NEAREST: Vec3 = Vec3::splat(1e6);

/// Time for which the first thread waits for another, so that it cannot do all the work before the others
/// have woken up. Too short: the test fails on a busy machine.
const RENDEZVOUS_TIMEOUT: Duration = Duration::from_secs(30);

/// The threads that have queried the shape.
#[derive(Clone, Default)]
pub struct ThreadProbe(Arc<(Mutex<HashSet<ThreadId>>, Condvar)>);

impl ThreadProbe {
    /// The shape, which moves no cloth.
    pub fn shape(&self) -> SharedShape {
        SharedShape::new(self.clone())
    }

    /// Number of threads so far.
    pub fn count(&self) -> usize {
        self.0.0.lock().expect("no thread panics").len()
    }

    fn record(&self) {
        let (threads, arrived) = &*self.0;
        let mut threads = threads.lock().expect("no thread panics");
        if threads.insert(thread::current().id()) {
            arrived.notify_all();
            let alone = |threads: &mut HashSet<_>| threads.len() < 2;
            drop(arrived.wait_timeout_while(threads, RENDEZVOUS_TIMEOUT, alone));
        }
    }
}

impl PointQuery for ThreadProbe {
    fn project_local_point(&self, _: Vec3, _: bool) -> PointProjection {
        self.record();
        PointProjection::new(false, NEAREST)
    }

    fn project_local_point_and_get_feature(&self, point: Vec3) -> (PointProjection, FeatureId) {
        (self.project_local_point(point, true), FeatureId::Unknown)
    }
}

impl RayCast for ThreadProbe {
    fn cast_local_ray_and_get_normal(&self, _: &Ray, _: f32, _: bool) -> Option<RayIntersection> {
        None
    }
}

impl Shape for ThreadProbe {
    fn compute_local_aabb(&self) -> Aabb {
        Aabb::from_half_extents(Vec3::ZERO, Vec3::splat(EXTENT))
    }

    fn compute_local_bounding_sphere(&self) -> BoundingSphere {
        BoundingSphere::new(Vec3::ZERO, 2.0 * EXTENT)
    }

    fn clone_dyn(&self) -> Box<dyn Shape> {
        Box::new(self.clone())
    }

    fn scale_dyn(&self, _: Vec3, _: u32) -> Option<Box<dyn Shape>> {
        None
    }

    fn mass_properties(&self, _: f32) -> MassProperties {
        MassProperties::default()
    }

    fn shape_type(&self) -> ShapeType {
        ShapeType::Custom
    }

    fn as_typed_shape(&self) -> TypedShape<'_> {
        TypedShape::Custom(self)
    }

    fn ccd_thickness(&self) -> f32 {
        0.0
    }

    fn ccd_angular_thickness(&self) -> f32 {
        0.0
    }
}
