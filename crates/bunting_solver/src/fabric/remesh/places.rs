//! The places of nodes on a mesh: at pins, along its border, at whole phases of the lattice within, and at vertices where these leave gaps.

use glam::{DVec2, DVec3};

use super::boxes::Boxes;
use super::phases::Lattice;
use super::place::Place;
use super::source::Source;
use super::walk::Walks;
use crate::fabric::faces::Faces;

/// Least distance between two nodes along the surface, in cells. Larger: gaps. Smaller: short links, which need more substeps.
pub(super) const LEAST_DISTANCE: f64 = 0.6;

/// The same from a place on the border, on which distances are measured along it, too.
const LEAST_AT_BORDER: f64 = 0.1;

/// The same from a place in the middle of a strip, in widths of the strip. From half a width on, its own borders are too near.
const LEAST_IN_STRIP: f64 = 0.4;

/// The same between pins. Larger: nodes beside a pin that is none do not follow it.
const LEAST_BETWEEN_PINS: f64 = 0.4;

/// The same between a point and pins. Larger: points that lie close together have one node. Smaller: triangles between nodes become slivers.
const LEAST_BETWEEN_POINTS: f64 = 0.02;

/// Least distance of a vertex in a gap from nodes, in cells.
const GAP: f64 = 0.9;

/// How far a place may lie outside of a triangle in which it counts, as a part of it.
const OUTSIDE: f64 = 1e-3;

/// What places are chosen from.
pub(super) struct Choice<'a> {
    pub source: &'a Source<'a>,
    pub lattice: &'a Lattice,
    /// Size of a cell, m.
    pub size: f64,
}

impl Choice<'_> {
    /// The places of nodes, no two of them too near one another.
    pub fn places(&self) -> Vec<Place> {
        let faces = &self.source.faces;
        let mut chosen = Chosen::new(faces, self.size);
        let at_vertices = self.at_vertices();
        let is_given = self.given();
        for (place, _) in at_vertices.iter().zip(&is_given).filter(|(_, is_given)| **is_given) {
            let is_point = place.vertex.is_some_and(|at| self.source.points.contains(&at));
            chosen.add(*place, if is_point { LEAST_BETWEEN_POINTS } else { LEAST_BETWEEN_PINS });
        }
        let on_border = self.on_border(&is_given);
        on_border.iter().for_each(|place| chosen.add(*place, LEAST_AT_BORDER));
        for (place, width) in self.along_strips(&on_border) {
            chosen.add(place, LEAST_IN_STRIP * width);
        }
        for triangle in 0..faces.count() as u32 {
            for place in self.within(triangle) {
                chosen.add(place, LEAST_DISTANCE);
            }
        }
        chosen.fill(self.source, &at_vertices, GAP);
        chosen.places
    }

    /// Whether each vertex is a node: points, and pins but for those between pins at the border, on whose edges nodes are pinned, too, and
    /// those among pins.
    fn given(&self) -> Vec<bool> {
        let Source { mesh, faces, positions, points, .. } = self.source;
        let mut free_near = vec![0; positions.len()];
        let mut pins_beside = vec![0; positions.len()];
        for triangle in 0..faces.count() as u32 {
            let corners = faces.particles(triangle);
            for side in 0..3 {
                let [one, other] = [corners[side], corners[(side + 1) % 3]];
                let is_border = faces.across(triangle, side).is_none();
                for [here, there] in [[one, other], [other, one]] {
                    match mesh.is_pinned(there) {
                        true => pins_beside[here as usize] += u32::from(is_border),
                        false => free_near[here as usize] += 1,
                    }
                }
            }
        }
        let is_given = |vertex: usize| {
            let is_between = pins_beside[vertex] == 2 || free_near[vertex] == 0;
            mesh.is_pinned(vertex as u32) && !is_between
        };
        let mut are_given: Vec<bool> = (0..positions.len()).map(is_given).collect();
        points.iter().for_each(|point| are_given[*point as usize] = true);
        are_given
    }

    /// A place at each vertex.
    fn at_vertices(&self) -> Vec<Place> {
        let Source { faces, positions, .. } = self.source;
        let mut places = vec![None; positions.len()];
        for triangle in 0..faces.count() as u32 {
            for (corner, vertex) in faces.particles(triangle).into_iter().enumerate() {
                let weights = [0, 1, 2].map(|at| if at == corner { 1.0 } else { 0.0 });
                places[vertex as usize].get_or_insert_with(|| self.place(triangle, weights));
            }
        }
        places.into_iter().flatten().collect()
    }

    /// The place with some barycentric coordinates.
    pub fn place(&self, triangle: u32, weights: [f64; 3]) -> Place {
        let Source { faces, positions, normals, .. } = self.source;
        let corners = faces.particles(triangle);
        let sum = |of: &[DVec3]| -> DVec3 {
            corners.iter().zip(weights).map(|(&at, weight)| of[at as usize] * weight).sum()
        };
        let vertex = (0..3).find(|&at| weights[at] == 1.0).map(|at| corners[at]);
        let normal = sum(normals).normalize_or_zero();
        Place { triangle, weights, at: sum(positions), normal, vertex }
    }

    /// Places with whole phases in a triangle.
    fn within(&self, triangle: u32) -> Vec<Place> {
        let corners = self.source.faces.particles(triangle);
        let Some([a, b, c]) = self.lattice.of_triangle(corners) else { return Vec::new() };
        let (along, across) = (b - a, c - a);
        let area = along.perp_dot(across);
        if area <= 0.0 {
            return Vec::new();
        }
        let (least, most) = (a.min(b).min(c).ceil(), a.max(b).max(c).floor());
        let mut places = Vec::new();
        for x in least.x as i64..=most.x as i64 {
            for y in least.y as i64..=most.y as i64 {
                let at = DVec2::new(x as f64, y as f64) - a;
                let (v, w) = (at.perp_dot(across) / area, along.perp_dot(at) / area);
                let weights = [1.0 - v - w, v, w];
                if weights.iter().all(|weight| *weight > -OUTSIDE) {
                    let weights = weights.map(|weight| weight.max(0.0));
                    let sum: f64 = weights.iter().sum();
                    places.push(self.place(triangle, weights.map(|weight| weight / sum)));
                }
            }
        }
        places
    }
}

/// Places that are chosen.
struct Chosen<'a> {
    size: f64,
    places: Vec<Place>,
    /// Indices of places, with a reach of a cell.
    boxes: Boxes,
    walks: Walks<'a>,
}

impl<'a> Chosen<'a> {
    fn new(faces: &'a Faces<'a>, size: f64) -> Self {
        Self { size, places: Vec::new(), boxes: Boxes::new(size), walks: Walks::on(faces) }
    }

    /// Adds a place unless one is nearer than a distance along the surface, in cells.
    fn add(&mut self, place: Place, least: f64) {
        let reach = least * self.size;
        let near = self.boxes.near(place.at).iter().map(|&at| &self.places[at as usize]);
        let near = near.filter(|other| other.at.distance_squared(place.at) < reach * reach);
        let near: Vec<u32> = near.map(|other| other.triangle).collect();
        let from = (place.triangle, place.at);
        if near.is_empty() || !self.walks.any_within(from, reach, |it| near.contains(&it)) {
            self.boxes.add(place.at, self.places.len() as u32);
            self.places.push(place);
        }
    }

    /// Adds those of some places, which lie at the vertices of a mesh in their order, that are farther from all others than a
    /// distance along the surface, in cells. One walk from each place marks the vertices near it: a dense mesh has many more
    /// vertices than places.
    fn fill(&mut self, source: &Source, vertices: &[Place], least: f64) {
        let reach = least * self.size;
        let mut is_near = vec![false; source.positions.len()];
        self.places
            .iter()
            .for_each(|it| mark_near(&mut self.walks, source, it, reach, &mut is_near));
        for place in vertices {
            if place.vertex.is_some_and(|vertex| !is_near[vertex as usize]) {
                mark_near(&mut self.walks, source, place, reach, &mut is_near);
                self.places.push(*place);
            }
        }
    }
}

/// Marks the vertices within a distance of a place along the surface, m.
fn mark_near(walks: &mut Walks, source: &Source, place: &Place, reach: f64, is_near: &mut [bool]) {
    walks.any_within((place.triangle, place.at), reach, |triangle| {
        for corner in source.faces.particles(triangle) {
            let away = source.positions[corner as usize].distance_squared(place.at);
            is_near[corner as usize] |= away < reach * reach;
        }
        false
    });
}
