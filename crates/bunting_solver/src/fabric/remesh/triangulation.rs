//! A triangulation that is changed step by step, until its vertices are nodes: their places become vertices, edges to
//! other vertices collapse (Hoppe et al. 1993, *Mesh optimization*), and edges flip until circles around triangles are empty
//! (Bobenko and Springborn 2007). The surface stays one manifold with the same borders.

use glam::DVec3;

use super::place::Place;
use super::triangle::{barycentric, cotangent};
use crate::fabric::faces::Faces;

/// Least barycentric coordinate of a place inside a triangle; with less it lies on an edge or a vertex.
const ON_EDGE: f64 = 0.05;

/// Least cosine of the angle by which a triangle turns as an edge collapses or flips.
const LEAST_TURN: f64 = 0.3;

/// Least qualities of triangles beside an edge that collapses, one after the other. Lower ones at first: slivers, which no flip
/// removes. Without the last one vertices stay that are no nodes.
const LEAST_QUALITIES: [f64; 3] = [0.4, 0.2, 0.05];

/// Quality below which a triangle does not tell which way the surface faces.
const SLIVER: f64 = 0.1;

/// Greatest sum of the cotangents of the angles opposite to an edge that flips. Nearer to zero: the diagonals of squares flip by rounding.
const FLIPS: f64 = -1e-3;

/// How often edges flip and collapse at most for each quality.
const ROUNDS: usize = 6;

/// Triangles, of which the first are those of a mesh.
pub(super) struct Triangulation {
    positions: Vec<DVec3>,
    normals: Vec<DVec3>,
    /// None that are gone.
    triangles: Vec<Option<[u32; 3]>>,
    /// The triangles at each vertex.
    around: Vec<Vec<u32>>,
    /// Whether the triangles at each vertex have changed since its edges were flipped.
    is_changed: Vec<bool>,
    /// The triangle of the mesh that each triangle began as a part of.
    origins: Vec<u32>,
    /// The triangles that began as parts of each triangle of the mesh.
    parts: Vec<Vec<u32>>,
    /// The other end of the edge by whose collapse each vertex is gone.
    collapsed_to: Vec<Option<u32>>,
}

impl Triangulation {
    pub fn of(faces: &Faces, positions: &[DVec3], normals: &[DVec3]) -> Self {
        let mut it = Self {
            positions: positions.to_vec(),
            normals: normals.to_vec(),
            triangles: Vec::new(),
            around: vec![Vec::new(); positions.len()],
            is_changed: vec![true; positions.len()],
            origins: Vec::new(),
            parts: vec![Vec::new(); faces.count()],
            collapsed_to: vec![None; positions.len()],
        };
        for triangle in 0..faces.count() as u32 {
            it.add(faces.particles(triangle), triangle);
        }
        it
    }

    fn add(&mut self, corners: [u32; 3], origin: u32) {
        let index = self.triangles.len() as u32;
        self.triangles.push(Some(corners));
        self.origins.push(origin);
        self.parts[origin as usize].push(index);
        for at in corners.map(|at| at as usize) {
            self.around[at].push(index);
            self.is_changed[at] = true;
        }
    }

    fn remove(&mut self, triangle: u32) {
        for at in self.triangles[triangle as usize].take().into_iter().flatten() {
            self.around[at as usize].retain(|other| *other != triangle);
        }
    }

    fn corners(&self, triangle: u32) -> [u32; 3] {
        self.triangles[triangle as usize].unwrap_or_default()
    }

    /// The triangles at an edge, each with the corner opposite to it.
    fn at_edge(&self, one: u32, other: u32) -> impl Iterator<Item = (u32, u32)> {
        self.around[one as usize].iter().filter_map(move |&triangle| {
            let corners = self.corners(triangle);
            let opposite = corners.iter().find(|at| ![one, other].contains(at))?;
            corners.contains(&other).then_some((triangle, *opposite))
        })
    }

    /// The first three triangles at an edge, each with the corner opposite to it.
    fn first_at_edge(&self, one: u32, other: u32) -> [Option<(u32, u32)>; 3] {
        let mut at_edge = self.at_edge(one, other);
        [at_edge.next(), at_edge.next(), at_edge.next()]
    }

    /// Makes vertices of places, and removes other vertices as far as that is possible. The place of each vertex.
    pub fn join(&mut self, places: &[Place]) -> Vec<Option<Place>> {
        let vertices: Vec<Option<u32>> = places.iter().map(|place| self.insert(place)).collect();
        let mut joined = vec![None; self.positions.len()];
        for (place, vertex) in places.iter().zip(vertices) {
            if let Some(vertex) = vertex {
                self.positions[vertex as usize] = place.at;
                joined[vertex as usize] = Some(*place);
            }
        }
        for least in LEAST_QUALITIES {
            for _ in 0..ROUNDS {
                let flips = self.flip_edges();
                let others = (0..joined.len() as u32).filter(|&at| joined[at as usize].is_none());
                let moves = others.filter(|&vertex| self.collapse(vertex, least)).count();
                if flips + moves == 0 {
                    break;
                }
            }
        }
        self.flip_edges();
        joined
    }

    /// Makes a vertex of a place, or finds the one that it lies at. None if its triangle is gone.
    fn insert(&mut self, place: &Place) -> Option<u32> {
        if place.vertex.is_some() {
            return place.vertex;
        }
        let parts = self.parts[place.triangle as usize].iter();
        let within = parts.filter_map(|&part| {
            let corners = self.triangles[part as usize]?;
            Some((part, corners, barycentric(place.at, self.points(corners))))
        });
        let least = |weights: [f64; 3]| weights.into_iter().fold(f64::INFINITY, f64::min);
        let (part, corners, weights) =
            within.max_by(|one, other| least(one.2).total_cmp(&least(other.2)))?;
        if let Some(corner) = (0..3).find(|&at| weights[at] > 1.0 - 2.0 * ON_EDGE) {
            return Some(corners[corner]);
        }
        let vertex = self.positions.len() as u32;
        self.positions.push(place.at);
        self.normals.push(place.normal);
        self.around.push(Vec::new());
        self.is_changed.push(true);
        self.collapsed_to.push(None);
        match (0..3).find(|&at| weights[at] < ON_EDGE) {
            Some(opposite) => {
                let [one, other] = [1, 2].map(|by| corners[(opposite + by) % 3]);
                let at_edge: Vec<(u32, u32)> = self.at_edge(one, other).collect();
                for (triangle, _) in at_edge {
                    for gone in [one, other] {
                        self.add(self.replaced(triangle, gone, vertex), self.origin(triangle));
                    }
                    self.remove(triangle);
                }
            }
            None => {
                for gone in corners {
                    self.add(self.replaced(part, gone, vertex), self.origin(part));
                }
                self.remove(part);
            }
        }
        Some(vertex)
    }

    /// The corners of a triangle with one vertex in place of another.
    fn replaced(&self, triangle: u32, from: u32, to: u32) -> [u32; 3] {
        self.corners(triangle).map(|at| if at == from { to } else { at })
    }

    fn origin(&self, triangle: u32) -> u32 {
        self.origins[triangle as usize]
    }

    /// The neighbours of a vertex, in memory that is used again.
    fn near(&self, vertex: u32, mut near: Vec<u32>) -> Vec<u32> {
        near.clear();
        let corners = self.around[vertex as usize].iter().flat_map(|&it| self.corners(it));
        near.extend(corners.filter(|&at| at != vertex));
        near.sort_unstable();
        near.dedup();
        near
    }

    /// Collapses the edge from a vertex for which the triangles around it keep most quality; false if none may collapse.
    fn collapse(&mut self, vertex: u32, least: f64) -> bool {
        let near = self.near(vertex, Vec::new());
        let is_border = near.len() > self.around[vertex as usize].len();
        let allows = |&&(_, into): &&(f64, u32)| {
            let between = self.at_edge(vertex, into).count();
            let is_shared = |at: &&u32| **at != into && self.at_edge(into, **at).next().is_some();
            let shared = near.iter().filter(is_shared).count();
            shared == between && (!is_border || between == 1)
        };
        let with_quality = near.iter().map(|&into| (self.quality_after(vertex, into), into));
        let mut sound: Vec<(f64, u32)> = with_quality.filter(|it| it.0 > least).collect();
        sound.sort_by(|one, other| other.0.total_cmp(&one.0));
        let Some(&(_, into)) = sound.iter().find(allows) else { return false };
        self.collapsed_to[vertex as usize] = Some(into);
        for triangle in self.around[vertex as usize].clone() {
            if !self.corners(triangle).contains(&into) {
                self.add(self.replaced(triangle, vertex, into), self.origin(triangle));
            }
            self.remove(triangle);
        }
        true
    }

    /// Least quality of the triangles around a vertex after the edge to a neighbour has collapsed; zero if one of them turns over.
    fn quality_after(&self, vertex: u32, into: u32) -> f64 {
        let around = self.around[vertex as usize].iter();
        let kept = around.filter(|triangle| !self.corners(**triangle).contains(&into));
        let quality = |&triangle: &u32| {
            let after = self.replaced(triangle, vertex, into);
            let is_kept = self.faces_alike(after, &[self.corners(triangle)]);
            if is_kept { self.quality(after) } else { 0.0 }
        };
        kept.map(quality).fold(1.0, f64::min)
    }

    /// Whether a triangle faces the way of its corners, and of those that it replaces, unless these are slivers or turned over.
    fn faces_alike(&self, after: [u32; 3], before: &[[u32; 3]]) -> bool {
        let normal = self.normal(after);
        let tells = |it: &&[u32; 3]| self.quality(**it) > SLIVER && self.faces_corners(**it);
        let mut sound = before.iter().filter(tells);
        self.faces_corners(after) && sound.all(|it| self.normal(*it).dot(normal) > LEAST_TURN)
    }

    /// Whether a triangle faces the way of its corners.
    fn faces_corners(&self, corners: [u32; 3]) -> bool {
        let of_corners: DVec3 = corners.iter().map(|at| self.normals[*at as usize]).sum();
        self.normal(corners).dot(of_corners) > 0.0
    }

    fn points(&self, corners: [u32; 3]) -> [DVec3; 3] {
        corners.map(|at| self.positions[at as usize])
    }

    fn normal(&self, corners: [u32; 3]) -> DVec3 {
        let [a, b, c] = self.points(corners);
        (b - a).cross(c - a).normalize_or_zero()
    }

    /// The area of a triangle over that of an equilateral one with sides of the same mean square.
    fn quality(&self, corners: [u32; 3]) -> f64 {
        let [a, b, c] = self.points(corners);
        let squares = a.distance_squared(b) + b.distance_squared(c) + c.distance_squared(a);
        2.0 * 3.0_f64.sqrt() * (b - a).cross(c - a).length() / squares
    }

    /// Flips edges for which that makes circles around triangles empty; their number.
    fn flip_edges(&mut self) -> usize {
        let mut flips = 0;
        let none = vec![false; self.positions.len()];
        let is_changed = core::mem::replace(&mut self.is_changed, none);
        let mut near = Vec::new();
        for vertex in (0..self.positions.len() as u32).filter(|at| is_changed[*at as usize]) {
            near = self.near(vertex, near);
            for &other in &near {
                if vertex < other || !is_changed[other as usize] {
                    flips += usize::from(self.flip(vertex, other));
                }
            }
        }
        flips
    }

    /// Flips the edge between two vertices, if that makes both circles around its triangles empty.
    fn flip(&mut self, one: u32, other: u32) -> bool {
        let [Some((first, left)), Some((second, right)), None] = self.first_at_edge(one, other)
        else {
            return false;
        };
        let cotangent = |opposite: u32| cotangent(self.points([one, other, opposite]));
        if cotangent(left) + cotangent(right) >= FLIPS || self.at_edge(left, right).next().is_some()
        {
            return false;
        }
        let before = [first, second].map(|triangle| self.corners(triangle));
        let after = [self.replaced(first, one, right), self.replaced(second, other, left)];
        let is_kept = after.iter().all(|corners| self.faces_alike(*corners, &before));
        if is_kept {
            for (triangle, corners) in [first, second].into_iter().zip(after) {
                self.add(corners, self.origin(triangle));
                self.remove(triangle);
            }
        }
        is_kept
    }

    /// The vertex that is left where one was.
    pub fn left_of(&self, mut vertex: u32) -> u32 {
        while let Some(into) = self.collapsed_to[vertex as usize] {
            vertex = into;
        }
        vertex
    }

    /// Of each triangle that is left one of the mesh near it.
    pub fn origins(&self) -> impl Iterator<Item = u32> {
        let left = self.triangles.iter().zip(&self.origins);
        left.filter(|(triangle, _)| triangle.is_some()).map(|(_, origin)| *origin)
    }

    /// The triangles that are left.
    pub fn triangles(&self) -> impl Iterator<Item = [u32; 3]> {
        self.triangles.iter().copied().flatten()
    }
}
