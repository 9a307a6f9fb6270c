//! The particles that nodes are interpolated from.
//!
//! A node within a triangle of a curved mesh would lie below the surface. The value of a polynomial that is fitted to the particles
//! around lies on it up to fifth or third order, (`fit.rs`).

use glam::DVec3;

use super::boxes::Boxes;
use super::fit::{GREATEST_SUM, RADIUS, fit_smooth};
use super::place::Place;
use super::source::Source;
use crate::fabric::interpolation::{Interpolation, Term};

/// Least cosine of the angle between the normals of a node and a particle that counts.
const ALIKE: f64 = 0.5;

/// The row of each node: one particle, if it lies on one; a polynomial's value; or that of `or_else`, of pinned nodes always.
pub(super) fn rows(
    places: &[Place],
    source: &Source,
    size: f64,
    is_pinned: impl Fn(usize) -> bool,
    or_else: impl Fn(usize) -> Vec<Term>,
) -> Interpolation {
    let radius = RADIUS * size;
    let mut boxes = Boxes::new(radius);
    for (index, &at) in (0..).zip(&source.positions) {
        boxes.add(at, index);
    }
    let mut rows = Interpolation::default();
    for (node, place) in places.iter().enumerate() {
        let fitted = || {
            let near = particles_near(place, source, boxes.near(place.at), radius);
            fit_smooth(&near, GREATEST_SUM)
        };
        let row = match place.vertex {
            Some(from) => Some(vec![Term { from, weight: 1.0 }]),
            None if is_pinned(node) => None,
            None => fitted(),
        };
        rows.push(row.unwrap_or_else(|| or_else(node)));
    }
    rows
}

/// The particles around a place, relative to it in its plane in units of the radius, with a weight as third coordinate.
fn particles_near(place: &Place, source: &Source, near: &[u32], radius: f64) -> Vec<(u32, DVec3)> {
    let x = place.normal.any_orthonormal_vector();
    let y = place.normal.cross(x);
    let weighted = near.iter().filter_map(|&at| {
        let away = (source.positions[at as usize] - place.at) / radius;
        let nearness = 1.0 - away.length_squared();
        let is_alike = source.normals[at as usize].dot(place.normal) > ALIKE;
        let along = DVec3::new(away.dot(x), away.dot(y), nearness * nearness);
        (nearness > 0.0 && is_alike).then_some((at, along))
    });
    weighted.collect()
}
