//! A mesh whose long edges are halved, so that it has vertices wherever the directions and phases of a lattice are needed, and that
//! has vertices at points.

use std::collections::{BinaryHeap, HashMap};

use glam::{Vec2, Vec3};

use super::point_on::PointOn;
use crate::fabric::interpolation::Term;
use crate::fabric::mesh::{RestMesh, Surface};
use crate::fabric::topology::{self, Edge, ascending};

/// A mesh with halved edges. Its first vertices are those of the mesh that it was made from.
pub(in crate::fabric) struct Refined {
    pub mesh: RestMesh,
    pub surface: Surface,
    /// Of each vertex those of the mesh that it was made from, with their weights.
    pub origins: Vec<Vec<Term>>,
    /// The vertex at each point.
    pub points: Vec<u32>,
}

/// An edge that is to be halved: the longest one first, which keeps triangles from becoming slivers (Rivara 1984).
type Long = (u32, [u32; 2]);

/// What holds a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Pin {
    None,
    /// It alone is held.
    Alone,
    /// What lies between it and others is held with them.
    Joined,
}

/// A vertex of a refined mesh.
pub(super) struct Vertex {
    /// m.
    pub at: Vec3,
    pub uv: Vec2,
    pub pin: Pin,
    /// The vertices of the mesh that it was made from, with their weights.
    pub origins: Vec<Term>,
}

/// Triangles while edges are halved.
pub(super) struct Halving<'a> {
    pub mesh: &'a RestMesh,
    pub vertices: Vec<Vertex>,
    pub triangles: Vec<[u32; 3]>,
    pub corner_uv: Vec<[Vec2; 3]>,
    /// The triangle of the mesh that each triangle is a part of.
    pub part_of: Vec<u32>,
    /// The triangles at each edge.
    at_edges: HashMap<[u32; 2], Vec<u32>>,
    long: BinaryHeap<Long>,
    /// Greatest length of an edge, m.
    longest: f32,
}

impl Refined {
    /// The mesh with no edge longer than `longest`, m, and with vertices at points; none if that is the mesh itself.
    pub fn of(
        mesh: &RestMesh,
        surface: &Surface,
        longest: f32,
        points: &[PointOn],
    ) -> Option<Self> {
        let mut halving = Halving::of(mesh, surface, longest);
        let vertices: Vec<u32> = points.iter().map(|point| halving.insert(point)).collect();
        for (_, vertex) in points.iter().zip(&vertices).filter(|(point, _)| point.is_pinned) {
            halving.pin(*vertex);
        }
        halving.note_all();
        if halving.long.is_empty() && points.is_empty() {
            return None;
        }
        while let Some((_, ends)) = halving.long.pop() {
            halving.halve(ends);
        }
        halving.finish(vertices)
    }
}

impl<'a> Halving<'a> {
    fn of(mesh: &'a RestMesh, surface: &Surface, longest: f32) -> Self {
        let vertex = |from: u32| Vertex {
            at: mesh.positions[from as usize],
            uv: mesh.uv[from as usize],
            pin: if mesh.is_pinned(from) { Pin::Joined } else { Pin::None },
            origins: vec![Term { from, weight: 1.0 }],
        };
        let at_edge = |edge: &Edge| {
            let sides = core::iter::once(edge.side).chain(edge.other_side);
            (edge.ends, sides.map(|side| side.triangle).collect())
        };
        Self {
            mesh,
            vertices: (0..mesh.positions.len() as u32).map(vertex).collect(),
            triangles: mesh.triangles.clone(),
            corner_uv: surface.corner_uv.clone(),
            part_of: (0..mesh.triangles.len() as u32).collect(),
            at_edges: surface.edges.iter().map(at_edge).collect(),
            long: BinaryHeap::new(),
            longest,
        }
    }

    /// Marks all edges that are to be halved, in any order.
    fn note_all(&mut self) {
        let edges: Vec<[u32; 2]> = self.at_edges.keys().copied().collect();
        edges.into_iter().for_each(|ends| self.note(ends));
    }

    /// Marks an edge that is too long, or that would hold what lies between a point and another pin.
    fn note(&mut self, ends: [u32; 2]) {
        let [one, other] = ends.map(|end| &self.vertices[end as usize]);
        let length = one.at.distance(other.at);
        let (least, greatest) = (one.pin.min(other.pin), one.pin.max(other.pin));
        let would_hold = least == Pin::Alone && greatest > Pin::None;
        if length > self.longest || would_hold {
            // The bits of positive numbers are ordered as the numbers are.
            self.long.push((length.to_bits(), ascending(ends)));
        }
    }

    fn halve(&mut self, ends: [u32; 2]) {
        let [one, other] = ends.map(|end| &self.vertices[end as usize]);
        let middle = Vertex {
            at: one.at.midpoint(other.at),
            uv: one.uv.midpoint(other.uv),
            pin: self.pin_between(ends),
            origins: Term::sum([(&one.origins[..], 0.5), (&other.origins[..], 0.5)]),
        };
        self.cut(ends, 0.5, middle);
    }

    /// What holds the vertices on an edge.
    pub fn pin_between(&self, ends: [u32; 2]) -> Pin {
        let is_held = ends.iter().all(|end| self.vertices[*end as usize].pin == Pin::Joined);
        if is_held { Pin::Joined } else { Pin::None }
    }

    /// Cuts the triangles at an edge at a part of its way.
    pub fn cut(&mut self, ends: [u32; 2], part: f32, vertex: Vertex) {
        let Some(triangles) = self.at_edges.remove(&ends) else { return };
        let middle = self.vertices.len() as u32;
        self.vertices.push(vertex);
        let mut halves = [Vec::new(), Vec::new()];
        for triangle in triangles {
            let corners = self.triangles[triangle as usize];
            let uv = self.corner_uv[triangle as usize];
            // The edge runs from its first corner to the next one.
            let first = (0..3).find(|&at| ascending([corners[at], corners[(at + 1) % 3]]) == ends);
            let Some(first) = first else { continue };
            let [from, to, opposite] = [0, 1, 2].map(|by| (first + by) % 3);
            let is_along = corners[from] == ends[0];
            let of_middle = uv[from].lerp(uv[to], if is_along { part } else { 1.0 - part });
            self.replace(
                triangle,
                [corners[from], middle, corners[opposite]],
                [uv[from], of_middle, uv[opposite]],
            );
            let beyond = self.add(
                triangle,
                [middle, corners[to], corners[opposite]],
                [of_middle, uv[to], uv[opposite]],
            );
            self.move_edge([corners[to], corners[opposite]], triangle, beyond);
            self.join([middle, corners[opposite]], vec![triangle, beyond]);
            halves[usize::from(!is_along)].push(triangle);
            halves[usize::from(is_along)].push(beyond);
        }
        for (end, triangles) in ends.into_iter().zip(halves) {
            self.join([end, middle], triangles);
        }
    }

    /// Cuts a triangle in three around a vertex, with its texture coordinates.
    pub fn cut_in_three(&mut self, triangle: u32, uv: Vec2, vertex: Vertex) {
        let middle = self.vertices.len() as u32;
        self.vertices.push(vertex);
        let [a, b, c] = self.triangles[triangle as usize];
        let [of_a, of_b, of_c] = self.corner_uv[triangle as usize];
        self.replace(triangle, [a, b, middle], [of_a, of_b, uv]);
        let second = self.add(triangle, [b, c, middle], [of_b, of_c, uv]);
        let third = self.add(triangle, [c, a, middle], [of_c, of_a, uv]);
        self.move_edge([b, c], triangle, second);
        self.move_edge([c, a], triangle, third);
        self.join([a, middle], vec![triangle, third]);
        self.join([b, middle], vec![triangle, second]);
        self.join([c, middle], vec![second, third]);
    }

    fn replace(&mut self, triangle: u32, corners: [u32; 3], uv: [Vec2; 3]) {
        self.triangles[triangle as usize] = corners;
        self.corner_uv[triangle as usize] = uv;
    }

    /// Adds a part of a triangle.
    fn add(&mut self, of: u32, corners: [u32; 3], uv: [Vec2; 3]) -> u32 {
        self.triangles.push(corners);
        self.corner_uv.push(uv);
        self.part_of.push(self.part_of[of as usize]);
        self.triangles.len() as u32 - 1
    }

    /// Notes that an edge is one of another triangle.
    fn move_edge(&mut self, ends: [u32; 2], from: u32, to: u32) {
        let at_edge = self.at_edges.entry(ascending(ends)).or_default();
        at_edge.iter_mut().filter(|at| **at == from).for_each(|at| *at = to);
    }

    /// Adds an edge with its triangles.
    fn join(&mut self, ends: [u32; 2], triangles: Vec<u32>) {
        self.at_edges.insert(ascending(ends), triangles);
        self.note(ends);
    }

    fn finish(self, points: Vec<u32>) -> Option<Refined> {
        let Self { vertices, triangles, corner_uv, .. } = self;
        let edges = topology::edges(&triangles).ok()?;
        let count = vertices.len();
        let is_free = |vertex: &Vertex| f32::from(vertex.pin == Pin::None);
        let mesh = RestMesh {
            positions: vertices.iter().map(|vertex| vertex.at).collect(),
            uv: vertices.iter().map(|vertex| vertex.uv).collect(),
            triangles,
            particle_of_vertex: (0..count as u32).collect(),
            areas: vec![0.0; count],
            inverse_areas: vertices.iter().map(is_free).collect(),
        };
        let triangle_areas = mesh.triangle_areas();
        Some(Refined {
            mesh,
            surface: Surface { triangle_areas, corner_uv, edges },
            origins: vertices.into_iter().map(|vertex| vertex.origins).collect(),
            points,
        })
    }
}
