//! Velocities after a change of level: the momentum of before, and no more energy.

use glam::{DVec3, Vec3};

use super::LevelTransfer;
use super::rows::Rows;
use crate::fabric::Fabric;
use crate::geometry::energy::area_moment;

impl LevelTransfer {
    /// What shared particles have, and the mean of what the fine ones about them have beyond that, by
    /// their masses: nothing is lost on the way up and down again.
    pub(super) fn gather_velocities(&self, fine: &[Vec3]) -> Vec<Vec3> {
        let mut coarse: Vec<Vec3> = self.pick(fine).collect();
        let beyond = self.smooth.interpolate(&coarse).zip(fine).zip(free_masses(&self.fine));
        let beyond = beyond.map(|((smooth, &fine), mass)| (fine - smooth) * mass);
        let gathered = self.smooth.gather(beyond, coarse.len());
        for (particle, velocity) in coarse.iter_mut().enumerate() {
            if !self.coarse.is_pinned(particle) && self.masses[particle] > 0.0 {
                *velocity += gathered[particle] / self.masses[particle];
            }
        }
        coarse
    }
}

/// What each coarse particle has of the masses of free fine ones, in units of the density, m².
pub(super) fn gather_masses(smooth: &Rows, fine: &Fabric, coarse: usize) -> Vec<f32> {
    smooth.gather(free_masses(fine), coarse)
}

/// Masses of free particles in units of the density, m²; zero for those that are not.
fn free_masses(fabric: &Fabric) -> impl Iterator<Item = f32> + '_ {
    let free = |&inverse: &f32| if inverse > 0.0 { 1.0 / inverse } else { 0.0 };
    fabric.inverse_areas().iter().map(free)
}

/// Moves all free particles by one velocity, so that the momentum per density is `wanted`.
pub(super) fn match_momentum(fabric: &Fabric, wanted: DVec3, velocities: &mut [Vec3]) {
    let free = free_areas(fabric);
    let mass: f64 = free.iter().sum();
    if mass == 0.0 {
        return;
    }
    // Twice: what rounding leaves of the first.
    for _ in 0..2 {
        let missing = ((wanted - area_moment(fabric, velocities)) / mass).as_vec3();
        for (velocity, _) in velocities.iter_mut().zip(&free).filter(|(_, area)| **area > 0.0) {
            *velocity += missing;
        }
    }
}

/// Twice the kinetic energy per density, in the frame that moves with the centre of mass.
pub(super) fn agitation(fabric: &Fabric, velocities: &[Vec3]) -> f64 {
    let mean = area_moment(fabric, velocities) / f64::from(fabric.area());
    let areas = fabric.particle_areas().iter().map(|&area| f64::from(area));
    areas.zip(velocities).map(|(area, v)| area * (v.as_dvec3() - mean).length_squared()).sum()
}

/// Slows free particles relative to their mean, which keeps the momentum, until the agitation is at
/// most `limit`, or as near as that goes.
pub(super) fn calm(fabric: &Fabric, limit: f64, velocities: &mut [Vec3]) {
    let free = free_areas(fabric);
    let mass: f64 = free.iter().sum();
    let now = agitation(fabric, velocities);
    if now <= limit || mass == 0.0 {
        return;
    }
    let moving = || free.iter().zip(&*velocities).map(|(area, v)| (area, v.as_dvec3()));
    let mean = moving().map(|(area, v)| v * *area).sum::<DVec3>() / mass;
    let about_mean: f64 = moving().map(|(area, v)| area * (v - mean).length_squared()).sum();
    let kept = (1.0 - (now - limit) / about_mean).max(0.0).sqrt();
    if !kept.is_finite() {
        return;
    }
    for (velocity, _) in velocities.iter_mut().zip(&free).filter(|(_, area)| **area > 0.0) {
        *velocity = (mean + (velocity.as_dvec3() - mean) * kept).as_vec3();
    }
}

/// Areas of the particles that are not pinned, m²; zero for those that are.
fn free_areas(fabric: &Fabric) -> Vec<f64> {
    let areas = fabric.particle_areas().iter().enumerate();
    areas
        .map(|(particle, &area)| if fabric.is_pinned(particle) { 0.0 } else { f64::from(area) })
        .collect()
}
