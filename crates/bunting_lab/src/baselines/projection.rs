//! The projection of two vertices to their distance at rest (thesis, equations 4.17 and 4.18).

use glam::Vec3;

use super::sheet::Link;

/// Moves both ends of a link a fraction `stiffness` of the way to its length at rest.
pub fn project(link: &Link, stiffness: f32, positions: &mut [Vec3], inverse_masses: &[f32]) {
    let (wa, wb) = (inverse_masses[link.a], inverse_masses[link.b]);
    let d = positions[link.b] - positions[link.a];
    let length = d.length_squared().sqrt();
    let mobility = wa + wb;
    if mobility == 0.0 || length == 0.0 {
        return;
    }
    let pull = d * (stiffness * (length - link.rest) / (length * mobility));
    positions[link.a] += pull * wa;
    positions[link.b] -= pull * wb;
}
