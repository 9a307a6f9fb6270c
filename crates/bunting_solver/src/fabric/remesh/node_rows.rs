//! The particles that nodes are interpolated from.
//!
//! A node within a triangle of a curved mesh would lie below the surface. The value of a polynomial that is fitted to the particles
//! around lies on it up to fifth or third order, (`fit.rs`).

use glam::DVec3;

use super::fit::{GREATEST_SUM, RADIUS, fit_smooth};
use super::place::Place;
use super::source::Source;
use super::walk::Walks;
use crate::fabric::interpolation::{Interpolation, Term};

/// Least cosine of the angle between the normals of a node and a particle that counts.
const ALIKE: f64 = 0.5;

/// Most particles that count, the nearest ones. A quartic has fifteen coefficients; more particles than four times as many bring
/// nothing but time.
const MOST: usize = 60;

/// The row of each node: one particle, if it lies on one; a polynomial's value; or that of `or_else`, of pinned nodes always.
pub(super) fn rows(
    places: &[Place],
    source: &Source,
    size: f64,
    is_pinned: impl Fn(usize) -> bool,
    or_else: impl Fn(usize) -> Vec<Term>,
) -> Interpolation {
    let mut around = Around::new(source);
    let mut rows = Interpolation::default();
    for (node, place) in places.iter().enumerate() {
        let row = match place.vertex {
            Some(from) => Some(vec![Term { from, weight: 1.0 }]),
            None if is_pinned(node) => None,
            None => fit_smooth(&around.of(place, RADIUS * size), GREATEST_SUM),
        };
        rows.push(row.unwrap_or_else(|| or_else(node)));
    }
    rows
}

/// Finds the particles around places.
struct Around<'a> {
    source: &'a Source<'a>,
    walks: Walks<'a>,
    /// Of each particle the number of the last place that it was found for.
    found_for: Vec<u32>,
    /// Number of places so far.
    count: u32,
}

impl<'a> Around<'a> {
    fn new(source: &'a Source<'a>) -> Self {
        let found_for = vec![0; source.positions.len()];
        Self { source, walks: Walks::on(&source.faces), found_for, count: 0 }
    }

    /// The particles around a place, relative to it in its plane in units of the radius, with a weight as third coordinate. The
    /// radius, m, is smaller where it has more particles than count.
    fn of(&mut self, place: &Place, radius: f64) -> Vec<(u32, DVec3)> {
        let Source { positions, normals, faces, .. } = self.source;
        self.count += 1;
        let mut near: Vec<(f64, u32)> = Vec::with_capacity(3 * MOST);
        self.walks.any_within((place.triangle, place.at), radius, |triangle| {
            for corner in faces.particles(triangle) {
                let found_for = &mut self.found_for[corner as usize];
                if core::mem::replace(found_for, self.count) != self.count
                    && normals[corner as usize].dot(place.normal) > ALIKE
                {
                    near.push((positions[corner as usize].distance_squared(place.at), corner));
                }
            }
            // Triangles come ring by ring: the nearest particles are within the first rings.
            near.len() > 2 * MOST
        });
        near.sort_unstable_by(|one, other| one.0.total_cmp(&other.0).then(one.1.cmp(&other.1)));
        let farther = near.get(MOST).map_or(f64::INFINITY, |it| it.0.sqrt());
        let radius = radius.min(farther);
        let x = place.normal.any_orthonormal_vector();
        let y = place.normal.cross(x);
        let weighted = near.iter().take(MOST).map(|&(_, at)| {
            let away = (positions[at as usize] - place.at) / radius;
            let nearness = 1.0 - away.length_squared();
            (nearness > 0.0, at, DVec3::new(away.dot(x), away.dot(y), nearness * nearness))
        });
        weighted.filter(|it| it.0).map(|(_, at, along)| (at, along)).collect()
    }
}
