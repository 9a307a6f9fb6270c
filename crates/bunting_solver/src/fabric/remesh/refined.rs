//! A mesh whose long edges are halved, so that it has vertices wherever the directions and phases of a lattice are needed.

use std::collections::{BinaryHeap, HashMap};

use glam::{Vec2, Vec3};

use crate::fabric::interpolation::Term;
use crate::fabric::mesh::{RestMesh, Surface};
use crate::fabric::topology::{self, ascending};

/// A mesh with halved edges. Its first vertices are those of the mesh that it was made from.
pub(in crate::fabric) struct Refined {
    pub mesh: RestMesh,
    pub surface: Surface,
    /// Of each vertex those of the mesh that it was made from, with their weights.
    pub origins: Vec<Vec<Term>>,
}

/// An edge that is to be halved: the longest one first, which keeps triangles from becoming slivers (Rivara 1984).
type Long = (u32, [u32; 2]);

/// Triangles while edges are halved.
struct Halving {
    positions: Vec<Vec3>,
    uv: Vec<Vec2>,
    is_pinned: Vec<bool>,
    origins: Vec<Vec<Term>>,
    triangles: Vec<[u32; 3]>,
    corner_uv: Vec<[Vec2; 3]>,
    /// The triangles at each edge.
    at_edges: HashMap<[u32; 2], Vec<u32>>,
    long: BinaryHeap<Long>,
    /// Greatest length of an edge, m.
    longest: f32,
}

impl Refined {
    /// The mesh with no edge longer than `longest`, m; none if none is.
    pub fn of(mesh: &RestMesh, surface: &Surface, longest: f32) -> Option<Self> {
        let mut halving = Halving {
            positions: mesh.positions.clone(),
            uv: mesh.uv.clone(),
            is_pinned: (0..mesh.positions.len() as u32).map(|at| mesh.is_pinned(at)).collect(),
            origins: (0..mesh.positions.len() as u32)
                .map(|from| vec![Term { from, weight: 1.0 }])
                .collect(),
            triangles: mesh.triangles.clone(),
            corner_uv: surface.corner_uv.clone(),
            at_edges: HashMap::new(),
            long: BinaryHeap::new(),
            longest,
        };
        for edge in &surface.edges {
            let sides = core::iter::once(edge.side).chain(edge.other_side);
            halving.at_edges.insert(edge.ends, sides.map(|side| side.triangle).collect());
            halving.note(edge.ends);
        }
        if halving.long.is_empty() {
            return None;
        }
        while let Some((_, ends)) = halving.long.pop() {
            halving.halve(ends);
        }
        halving.finish()
    }
}

impl Halving {
    /// Marks an edge that is too long.
    fn note(&mut self, ends: [u32; 2]) {
        let [one, other] = ends.map(|end| self.positions[end as usize]);
        let length = one.distance(other);
        if length > self.longest {
            // The bits of positive numbers are ordered as the numbers are.
            self.long.push((length.to_bits(), ascending(ends)));
        }
    }

    fn halve(&mut self, ends: [u32; 2]) {
        let Some(triangles) = self.at_edges.remove(&ends) else { return };
        let [one, other] = ends.map(|end| end as usize);
        let middle = self.positions.len() as u32;
        self.positions.push(self.positions[one].midpoint(self.positions[other]));
        self.uv.push(self.uv[one].midpoint(self.uv[other]));
        self.is_pinned.push(self.is_pinned[one] && self.is_pinned[other]);
        self.origins.push(Term::sum([one, other].map(|end| (&self.origins[end][..], 0.5))));
        let mut halves = [Vec::new(), Vec::new()];
        for triangle in triangles {
            let corners = self.triangles[triangle as usize];
            let uv = self.corner_uv[triangle as usize];
            // The edge runs from its first corner to the next one.
            let first = (0..3).find(|&at| ascending([corners[at], corners[(at + 1) % 3]]) == ends);
            let Some(first) = first else { continue };
            let [from, to, opposite] = [0, 1, 2].map(|by| (first + by) % 3);
            let of_middle = uv[from].midpoint(uv[to]);
            let beyond = self.triangles.len() as u32;
            self.triangles[triangle as usize] = [corners[from], middle, corners[opposite]];
            self.corner_uv[triangle as usize] = [uv[from], of_middle, uv[opposite]];
            self.triangles.push([middle, corners[to], corners[opposite]]);
            self.corner_uv.push([of_middle, uv[to], uv[opposite]]);
            let moved =
                self.at_edges.entry(ascending([corners[to], corners[opposite]])).or_default();
            moved.iter_mut().filter(|at| **at == triangle).for_each(|at| *at = beyond);
            self.at_edges.insert(ascending([middle, corners[opposite]]), vec![triangle, beyond]);
            self.note([middle, corners[opposite]]);
            let is_along = corners[from] == ends[0];
            halves[usize::from(!is_along)].push(triangle);
            halves[usize::from(is_along)].push(beyond);
        }
        for (end, triangles) in ends.into_iter().zip(halves) {
            self.at_edges.insert(ascending([end, middle]), triangles);
            self.note([end, middle]);
        }
    }

    fn finish(self) -> Option<Refined> {
        let Self { positions, uv, is_pinned, origins, triangles, corner_uv, .. } = self;
        let edges = topology::edges(&triangles).ok()?;
        let count = positions.len();
        let mesh = RestMesh {
            positions,
            uv,
            triangles,
            particle_of_vertex: (0..count as u32).collect(),
            areas: vec![0.0; count],
            inverse_areas: is_pinned.iter().map(|is_pinned| f32::from(!is_pinned)).collect(),
        };
        let triangle_areas = mesh.triangle_areas();
        Some(Refined { mesh, surface: Surface { triangle_areas, corner_uv, edges }, origins })
    }
}
