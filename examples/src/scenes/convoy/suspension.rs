//! Wheels on springs, which rays find the ground for, and a driver who keeps speed and lane.

use avian3d::prelude::{
    Forces, ReadRigidBodyForces, SpatialQuery, SpatialQueryFilter, WriteRigidBodyForces,
};
use bevy::prelude::*;

use crate::scenes::convoy::ground::Ground;
use crate::scenes::convoy::vehicle::{MASS, SPEED, Vehicle};
use crate::scenes::convoy::wheel::{RADIUS, Wheel};

/// Length of an unloaded spring with its wheel, m.
const LENGTH: f32 = 1.0;

/// Stiffness of a spring, N/m, and its damping, N·s/m.
const STIFFNESS: f32 = 45_000.0;
const DAMPING: f32 = 5_000.0;

/// Rates at which the driver corrects speed and sideways slip, 1/s, and the lane, rad/m.
const THROTTLE: f32 = 2.0;
const GRIP: f32 = 6.0;
const LANE: f32 = 0.03;

/// Stiffness of the steering, N·m/rad, and its damping, N·m·s/rad.
const STEERING: f32 = 60_000.0;
const STEERING_DAMPING: f32 = 25_000.0;

/// Springs push the vehicles away from the ground, and hold the wheels on it.
pub fn carry(
    mut vehicles: Query<(&Transform, &Children, Forces), With<Vehicle>>,
    mut wheels: Query<(&Wheel, &mut Transform), Without<Vehicle>>,
    ground: Query<Entity, With<Ground>>,
    space: SpatialQuery,
) {
    for (pose, parts, mut body) in &mut vehicles {
        let mut parts = wheels.iter_many_mut(parts);
        while let Some((wheel, mut place)) = parts.fetch_next() {
            let mount = pose.transform_point(wheel.0);
            let on_ground = |entity| ground.contains(entity);
            let filter = SpatialQueryFilter::default();
            let hit =
                space.cast_ray_predicate(mount, -pose.up(), LENGTH, true, &filter, &on_ground);
            let length = hit.map_or(LENGTH, |hit| hit.distance);
            place.translation.y = wheel.0.y - length + RADIUS;
            if hit.is_some() {
                let rate = body.velocity_at_point(mount).dot(*pose.up());
                let force = STIFFNESS * (LENGTH - length) - DAMPING * rate;
                body.apply_force_at_point(force.max(0.0) * pose.up(), mount);
            }
        }
    }
}

/// The driver keeps speed and lane, and the tyres do not slip sideways.
pub fn steer(mut vehicles: Query<(&Transform, &Vehicle, Forces)>) {
    for (pose, vehicle, mut body) in &mut vehicles {
        let velocity = body.linear_velocity();
        let (ahead, aside) = (pose.forward(), pose.right());
        let throttle = MASS * THROTTLE * (SPEED - velocity.dot(*ahead));
        let grip = -MASS * GRIP * velocity.dot(*aside);
        body.apply_force(throttle * ahead + grip * aside);
        let wanted = Vec3::new(1.0, 0.0, LANE * (vehicle.lane - pose.translation.z)).normalize();
        let turn = STEERING * ahead.cross(wanted).y;
        let damping = STEERING_DAMPING * body.angular_velocity().y;
        body.apply_torque(Vec3::Y * (turn - damping));
    }
}
