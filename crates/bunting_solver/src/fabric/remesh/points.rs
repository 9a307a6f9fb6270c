//! Points on triangles become vertices.

use glam::DVec3;

use super::point_on::PointOn;
use super::refined::{Halving, Pin, Vertex};
use super::triangle::barycentric;
use crate::fabric::interpolation::Term;
use crate::fabric::topology::ascending;

/// Weight of a corner that is rounding: with less of one a point lies on the edge opposite to it, with less of two at the third one.
const ROUNDING: f64 = 1e-5;

impl Halving<'_> {
    /// Makes a vertex of a point before edges are halved, or finds the one that is there.
    pub fn insert(&mut self, point: &PointOn) -> u32 {
        let (part, weights) = self.part_at(point);
        let corners = self.triangles[part as usize];
        let next = self.vertices.len() as u32;
        let mut by_weight = [0, 1, 2];
        by_weight.sort_by(|&one, &other| weights[one].total_cmp(&weights[other]));
        let [least, middle, greatest] = by_weight;
        if weights[least] > ROUNDING {
            let uv = self.corner_uv[part as usize].into_iter().zip(weights);
            let uv = uv.map(|(uv, weight)| uv * weight as f32).sum();
            self.cut_in_three(part, uv, self.vertex_at(point, Pin::None));
            next
        } else if weights[middle] > ROUNDING {
            let ends = ascending([corners[middle], corners[greatest]]);
            let of_end = if ends[1] == corners[middle] { middle } else { greatest };
            let along = weights[of_end] / (weights[middle] + weights[greatest]);
            self.cut(ends, along as f32, self.vertex_at(point, self.pin_between(ends)));
            next
        } else {
            corners[greatest]
        }
    }

    /// Pins the vertex at a point. At one of the mesh, what lies between it and others is held, too.
    pub fn pin(&mut self, vertex: u32) {
        let is_of_mesh = (vertex as usize) < self.mesh.positions.len();
        let pin = &mut self.vertices[vertex as usize].pin;
        *pin = (*pin).max(if is_of_mesh { Pin::Joined } else { Pin::Alone });
    }

    /// The part of a point's triangle that it lies in, and its weights there.
    fn part_at(&self, point: &PointOn) -> (u32, [f64; 3]) {
        let corners = self.mesh.triangles[point.triangle as usize];
        let weights_of = |vertex: u32| {
            let origins = &self.vertices[vertex as usize].origins;
            let weight = |corner: u32| {
                let term = origins.iter().find(|term| term.from == corner);
                term.map_or(0.0, |term| f64::from(term.weight))
            };
            DVec3::from(corners.map(weight))
        };
        let at = DVec3::from(point.weights);
        let parts = (0..).zip(&self.part_of).filter(|(_, of)| **of == point.triangle);
        let within = parts.map(|(part, _): (u32, _)| {
            (part, barycentric(at, self.triangles[part as usize].map(weights_of)))
        });
        let least = |weights: [f64; 3]| weights.into_iter().fold(f64::INFINITY, f64::min);
        let best = within.max_by(|one, other| least(one.1).total_cmp(&least(other.1)));
        best.unwrap_or((point.triangle, point.weights))
    }

    /// The vertex at a point.
    fn vertex_at(&self, point: &PointOn, pin: Pin) -> Vertex {
        let corners = self.mesh.triangles[point.triangle as usize];
        let weighted = || corners.into_iter().zip(point.weights);
        let at = |corner: u32| self.vertices[corner as usize].at.as_dvec3();
        let uv = |corner: u32| self.vertices[corner as usize].uv;
        Vertex {
            at: weighted().map(|(corner, weight)| at(corner) * weight).sum::<DVec3>().as_vec3(),
            uv: weighted().map(|(corner, weight)| uv(corner) * weight as f32).sum(),
            pin,
            origins: weighted()
                .filter(|(_, weight)| *weight > 0.0)
                .map(|(from, weight)| Term { from, weight: weight as f32 })
                .collect(),
        }
    }
}
