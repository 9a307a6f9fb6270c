//! Nodes in place of the vertices of a mesh, so that lines through the nodes run straight along warp and weft. What solves these is the
//! net of their quads (`fabric/net/`).
//!
//! `refined` halves the long edges of the mesh, `frames` finds the directions of warp and weft at each vertex, `steps` the edges along
//! these, `phases` and `relaxation` a lattice, `places` nodes on the lattice and the border, and `triangulation` joins the nodes.
//! `node_rows` places them on the smooth surface, and `embedding` finds the places of the mesh's vertices between them.

mod border;
mod boxes;
mod embedding;
mod fit;
mod frames;
mod narrow;
mod node_rows;
mod phases;
mod place;
mod places;
mod point_on;
mod points;
mod refined;
mod relaxation;
mod source;
mod steps;
#[cfg(test)]
mod tests;
mod triangle;
mod triangulation;
mod walk;

use glam::{DVec3, Vec3};

use self::embedding::Cells;
use self::phases::Lattice;
use self::place::Place;
use self::places::Choice;
use self::triangle::part_along;
use self::triangulation::Triangulation;
use super::directions::{Directions, Towards};
use super::faces::Faces;
use super::interpolation::{Height, Interpolation, Term};
use super::mesh::RestMesh;
use super::topology::{self, Edge};

pub(super) use self::point_on::PointOn;
pub(super) use self::refined::Refined;
pub(super) use self::source::Source;
pub(super) use self::triangle::nearest_weights;

/// Least weight of free particles in a node that is free.
const LEAST_FREE: f64 = 0.01;

/// Nodes on a mesh, and triangles between them.
pub(super) struct Nodes {
    /// The nodes as particles, without areas.
    pub mesh: RestMesh,
    pub edges: Vec<Edge>,
    /// The directions in each triangle.
    pub directions: Directions,
    /// Of each particle the node that it is, and a node near it.
    pub node_of: Vec<Option<u32>>,
    node_near: Vec<Option<u32>>,
    /// Of each node the particles around it with their weights: those of the triangle that it lies on.
    pub corners: Vec<Vec<Term>>,
    /// Size of a cell, m.
    size: f64,
}

impl Nodes {
    /// On a lattice with cells of a size, m, along warp and weft, and on the border.
    ///
    /// # Errors
    ///
    /// A vertex near an edge that three triangles between nodes have.
    pub fn on_lattice(source: &Source, size: f64) -> Result<Self, u32> {
        let Source { faces, positions, normals, .. } = source;
        let frames = frames::frames(faces, &source.directions, normals);
        let lattice = Lattice::of(positions, source.edges, &frames, size);
        let chosen = Choice { source, lattice: &lattice, size }.places();
        let mut triangulation = Triangulation::of(faces, positions, normals);
        let joined = triangulation.join(&chosen);

        // Nodes in the order of the triangles.
        let mut number: Vec<Option<u32>> = vec![None; joined.len()];
        let mut places: Vec<Place> = Vec::new();
        let mut node_of = vec![None; positions.len()];
        let mut node_at = |vertex: u32| {
            *number[vertex as usize].get_or_insert_with(|| {
                let node = places.len() as u32;
                let place = joined[vertex as usize].unwrap_or_else(|| source.at_vertex(vertex));
                if let Some(vertex) = place.vertex {
                    node_of[vertex as usize] = Some(node);
                }
                places.push(place);
                node
            })
        };
        let triangles: Vec<[u32; 3]> =
            triangulation.triangles().map(|corners| corners.map(&mut node_at)).collect();
        let node_near = (0..positions.len() as u32)
            .map(|vertex| number[triangulation.left_of(vertex) as usize]);
        let node_near = node_near.collect();

        let is_pinned = |node: usize| source.free_part(&places[node]) < LEAST_FREE;
        let corners: Vec<Vec<Term>> = places.iter().map(|it| source.terms(it)).collect();
        let of_triangle = |node: usize| corners[node].clone();
        let rows = node_rows::rows(&places, source, size, is_pinned, of_triangle);
        let nearest = |[node, _]: [u32; 2]| Term::heaviest(&corners[node as usize]);
        let edges =
            topology::edges(&triangles).map_err(|of| nearest(of).map_or(0, |it| it.from))?;
        let count = places.len();
        let mesh = RestMesh {
            positions: source.interpolated(&rows),
            uv: places.iter().map(|place| source.uv(place)).collect(),
            triangles,
            particle_of_vertex: (0..count as u32).collect(),
            areas: vec![0.0; count],
            inverse_areas: (0..count).map(|at| if is_pinned(at) { 0.0 } else { 1.0 }).collect(),
        };
        let node_faces = Faces::new(&mesh.positions, &mesh.triangles, &edges);
        let warps = nearest_warps(source, &node_faces, triangulation.origins());
        Ok(Self {
            directions: Directions::of_warps(&node_faces, warps),
            mesh,
            edges,
            node_of,
            node_near,
            corners,
            size,
        })
    }

    /// The pinned nodes but those at points beside the first vertices of the mesh: points hold nothing else.
    pub fn pins_of_vertices(&self, source: &Source, count: usize) -> impl Iterator<Item = u32> {
        let beside = source.points.iter().map(|at| *at as usize).filter(move |at| *at >= count);
        let at_points: Vec<u32> = beside.filter_map(|at| self.node_of[at]).collect();
        let pinned =
            (0..self.mesh.positions.len() as u32).filter(|node| self.mesh.is_pinned(*node));
        pinned.filter(move |node| !at_points.contains(node))
    }

    /// The node at each point; the nearest one, of a pinned point the nearest pinned one, of a point at which there is none.
    pub fn of_points(&self, source: &Source) -> Vec<u32> {
        let nearest = |point: u32| {
            let away = |node: &u32| {
                let at = self.mesh.positions[*node as usize].as_dvec3();
                at.distance_squared(source.positions[point as usize])
            };
            let nodes = 0..self.mesh.positions.len() as u32;
            let held =
                nodes.filter(|node| self.mesh.is_pinned(*node) || !source.mesh.is_pinned(point));
            held.min_by(|one, other| away(one).total_cmp(&away(other)))
        };
        let of_point = |&point: &u32| self.node_of[point as usize].or_else(|| nearest(point));
        source.points.iter().map(|point| of_point(point).unwrap_or(0)).collect()
    }

    /// How the first places of the mesh follow the nodes, given the cells of nodes.
    ///
    /// # Errors
    ///
    /// A place that has no cell near it.
    pub fn carried<'a>(
        &self,
        source: &Source,
        cells: impl Iterator<Item = &'a [u32]>,
        count: usize,
    ) -> Result<OnNodes, u32> {
        let cells = Cells::new(cells, &self.mesh.positions, self.size);
        let pins: Vec<u32> = self.pins_of_vertices(source, count).collect();
        let mut on_nodes = OnNodes::default();
        for (place, &at) in (0_u32..).zip(&source.positions[..count]) {
            if let Some(from) = self.node_of[place as usize] {
                on_nodes.rows.push([Term { from, weight: 1.0 }]);
            } else if let (true, Some(terms)) =
                (source.mesh.is_pinned(place), self.between_pins(&pins, at))
            {
                let position = |term: &Term| self.mesh.positions[term.from as usize] * term.weight;
                let beside: Vec3 = terms.iter().map(position).sum();
                on_nodes.held.push((place, at.as_vec3() - beside));
                on_nodes.rows.push(terms);
            } else {
                let normal = source.normals[place as usize];
                let near = self.node_near[place as usize].ok_or(place)?;
                let within = cells.of(place, at, normal, near).ok_or(place)?;
                on_nodes.rows.push(within.terms);
                on_nodes.heights.extend(within.height);
            }
        }
        Ok(on_nodes)
    }

    /// The weights of the two pinned nodes nearest to a pinned place, on the line between them; none without pinned nodes.
    fn between_pins(&self, pins: &[u32], at: DVec3) -> Option<[Term; 2]> {
        let place = |node: u32| self.mesh.positions[node as usize].as_dvec3();
        let nearest = |but: Option<u32>| {
            let others = pins.iter().copied().filter(|node| Some(*node) != but);
            let away = |node: u32| place(node).distance_squared(at);
            others.min_by(|one, other| away(*one).total_cmp(&away(*other)))
        };
        let first = nearest(None)?;
        let second = nearest(Some(first)).unwrap_or(first);
        let part = part_along(at, place(first), place(second)).clamp(0.0, 1.0) as f32;
        let weights = [(first, 1.0 - part), (second, part)];
        Some(weights.map(|(from, weight)| Term { from, weight }))
    }
}

/// How places follow nodes.
#[derive(Default)]
pub(super) struct OnNodes {
    /// Of each place the nodes that it is interpolated from.
    pub rows: Interpolation,
    /// How far places lie above the surface between nodes.
    pub heights: Vec<Height>,
    /// How far pinned places lie from the line between the pinned nodes beside them, m.
    pub held: Vec<(u32, Vec3)>,
}

/// The warp in each triangle between nodes, given a triangle of the mesh near it: that of the nearest triangle of the mesh which
/// faces the same way, to which a walk from neighbour to neighbour leads.
fn nearest_warps(source: &Source, of: &Faces, near: impl Iterator<Item = u32>) -> Vec<Vec3> {
    let faces = &source.faces;
    let warp = |(triangle, near): (u32, u32)| {
        let (centre, normal) = (of.centre(triangle), of.normals[triangle as usize]);
        let away = |other: u32| {
            let is_alike = faces.normals[other as usize].dot(normal) > 0.0;
            (!is_alike, faces.centre(other).distance(centre))
        };
        let mut nearest = (away(near), near);
        loop {
            let mut others = faces.neighbours(nearest.1).map(|other| (away(other), other));
            let Some(nearer) = others.find(|other| other.0 < nearest.0) else { break };
            nearest = nearer;
        }
        let [a, b, _] = of.corners(triangle);
        let warp = source.directions.of_triangle(nearest.1, Towards::Warp);
        let warp = warp.reject_from(normal).try_normalize();
        warp.unwrap_or_else(|| (b - a).normalize_or(Vec3::X))
    };
    (0..of.count() as u32).zip(near).map(warp).collect()
}
