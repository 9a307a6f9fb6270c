//! Velocities after a change of level: equal linear momentum, and no more energy than before.

use glam::{DVec3, Vec3};

use crate::fabric::Fabric;
use crate::geometry::energy::area_moment;

/// Areas of the particles, m²; zero if they are pinned. Multiplied by the area density they are the masses of
/// the free particles.
pub(super) fn free_areas(fabric: &Fabric) -> impl Iterator<Item = f32> + '_ {
    let areas = fabric.particle_areas().iter().enumerate();
    areas.map(|(particle, &area)| if fabric.is_pinned(particle) { 0.0 } else { area })
}

/// Adds one velocity to all free particles, so that the momentum per area density becomes `wanted`, m³/s.
pub(super) fn match_momentum(fabric: &Fabric, wanted: DVec3, velocities: &mut [Vec3]) {
    let free_area: f64 = free_areas(fabric).map(f64::from).sum();
    if free_area == 0.0 {
        return;
    }
    // A second iteration corrects the rounding errors of the first.
    for _ in 0..2 {
        let missing = ((wanted - area_moment(fabric, velocities)) / free_area).as_vec3();
        for (velocity, area) in velocities.iter_mut().zip(free_areas(fabric)) {
            if area > 0.0 {
                *velocity += missing;
            }
        }
    }
}

/// Σ A |v − v̄|², m⁴/s², with v̄ the mean velocity: twice the kinetic energy per area density, in the frame that moves
/// with the centre of mass.
pub(super) fn internal_motion(fabric: &Fabric, velocities: &[Vec3]) -> f64 {
    let mean = area_moment(fabric, velocities) / f64::from(fabric.mass_area());
    let areas = fabric.particle_areas().iter().map(|&area| f64::from(area));
    areas.zip(velocities).map(|(area, v)| area * (v.as_dvec3() - mean).length_squared()).sum()
}

/// Scales the velocities of the free particles relative to their mean, which conserves the momentum, until
/// the [`internal_motion`] is at most `limit`, m⁴/s², or as close to it as scaling allows.
pub(super) fn limit_internal_motion(fabric: &Fabric, limit: f64, velocities: &mut [Vec3]) {
    let areas: Vec<f64> = free_areas(fabric).map(f64::from).collect();
    let free_area: f64 = areas.iter().sum();
    let now = internal_motion(fabric, velocities);
    if now <= limit || free_area == 0.0 {
        return;
    }
    let moving = || areas.iter().zip(&*velocities).map(|(area, v)| (area, v.as_dvec3()));
    let mean = moving().map(|(area, v)| v * *area).sum::<DVec3>() / free_area;
    let about_mean: f64 = moving().map(|(area, v)| area * (v - mean).length_squared()).sum();
    let scale = (1.0 - (now - limit) / about_mean).max(0.0).sqrt();
    if !scale.is_finite() {
        return;
    }
    for (velocity, _) in velocities.iter_mut().zip(&areas).filter(|(_, area)| **area > 0.0) {
        *velocity = (mean + (velocity.as_dvec3() - mean) * scale).as_vec3();
    }
}
