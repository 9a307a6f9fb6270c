//! The features of a fabric that may touch, and the patches in which they are looked up.

use std::collections::HashMap;

use crate::contact::itself::cell_groups::CellGroups;
use crate::contact::itself::patches::{Cell, Patch, patches_of};
use crate::fabric::Fabric;

/// An edge and the triangles beside it.
#[derive(Clone, Copy, Debug)]
pub(in crate::contact) struct Edge {
    pub ends: [u32; 2],
    /// The third corner of each triangle beside the edge; none beside a border.
    pub wings: [Option<u32>; 2],
    /// The index of the end that is farther from the border of the cloth, if the border is near.
    pub inner_end: Option<usize>,
}

/// The features of a triangle that it stands for in pairs of triangles, so that a pair of features is examined once
/// though several triangles share each (Curtis 2008, "Fast collision detection for deformable models using
/// representative-triangles").
#[derive(Clone, Debug, Default)]
pub(in crate::contact) struct Represented {
    pub particles: Vec<u32>,
    /// Indices of edges.
    pub edges: Vec<u32>,
}

/// The features of a fabric that may touch, and the patches in which they are looked up.
#[derive(Clone, Debug, Default)]
pub(crate) struct ContactMesh {
    /// Triangles, in the order of the cells.
    pub(in crate::contact) triangles: Vec<[u32; 3]>,
    pub(in crate::contact) edges: Vec<Edge>,
    /// For each triangle, the features that it stands for.
    pub(in crate::contact) represented: Vec<Represented>,
    pub(in crate::contact) patches: Vec<Patch>,
    pub(in crate::contact) cells: Vec<Cell>,
    pub(in crate::contact) cell_groups: CellGroups,
}

impl ContactMesh {
    pub fn of(fabric: &Fabric) -> Self {
        let (patches, cells, triangles) = patches_of(fabric);
        let mut represented = vec![Represented::default(); triangles.len()];
        let mut has_owner = vec![false; fabric.particle_count()];
        let mut edges: Vec<Edge> = Vec::new();
        let mut index_of = HashMap::new();
        for (triangle, represented) in triangles.iter().zip(&mut represented) {
            for corner in 0..3 {
                let particle = triangle[corner];
                if !core::mem::replace(&mut has_owner[particle as usize], true) {
                    represented.particles.push(particle);
                }
                let [from, to] = [particle, triangle[(corner + 1) % 3]];
                let wing = triangle[(corner + 2) % 3];
                match index_of.get(&[from.min(to), from.max(to)]) {
                    Some(&index) => edges[index as usize].wings[1] = Some(wing),
                    None => {
                        let index = edges.len() as u32;
                        index_of.insert([from.min(to), from.max(to)], index);
                        represented.edges.push(index);
                        edges.push(Edge {
                            ends: [from, to],
                            wings: [Some(wing), None],
                            inner_end: None,
                        });
                    }
                }
            }
        }
        set_inner_ends(&mut edges, fabric.particle_count());
        let cell_groups = CellGroups::of(&cells);
        Self { triangles, edges, represented, patches, cells, cell_groups }
    }

    /// The features of several cloths, the particles of each after those of the one before.
    pub(in crate::contact) fn joined<'a>(parts: impl Iterator<Item = (&'a Self, u32)>) -> Self {
        let mut all = Self::default();
        let mut first = 0;
        for (part, particles) in parts {
            let [triangles, edges, patches, cells] =
                [all.triangles.len(), all.edges.len(), all.patches.len(), all.cells.len()]
                    .map(|count| count as u32);
            let moved = |particle: u32| particle + first;
            all.triangles.extend(part.triangles.iter().map(|it| it.map(moved)));
            all.edges.extend(part.edges.iter().map(|edge| Edge {
                ends: edge.ends.map(moved),
                wings: edge.wings.map(|wing| wing.map(moved)),
                ..*edge
            }));
            all.represented.extend(part.represented.iter().map(|it| Represented {
                particles: it.particles.iter().map(|&particle| moved(particle)).collect(),
                edges: it.edges.iter().map(|edge| edge + edges).collect(),
            }));
            all.patches.extend(part.patches.iter().map(|patch| patch.moved(patches, cells, first)));
            all.cells.extend(part.cells.iter().map(|cell| cell.moved(cells, triangles, first)));
            first += particles;
        }
        all.cell_groups = CellGroups::of(&all.cells);
        all
    }

    /// Whether two triangles have a number of corners in common, or more.
    pub(in crate::contact) fn share_corners(&self, triangles: [usize; 2], count: usize) -> bool {
        let [one, other] = triangles.map(|triangle| self.triangles[triangle]);
        one.iter().filter(|corner| other.contains(corner)).nth(count - 1).is_some()
    }
}

/// Finds the inner ends of edges: those more edges away from the border.
fn set_inner_ends(edges: &mut [Edge], particles: usize) {
    /// Greatest number of edges to a border that is near.
    const NEAR: u32 = 4;
    let mut distance = vec![NEAR + 1; particles];
    for edge in edges.iter().filter(|edge| edge.wings[1].is_none()) {
        edge.ends.iter().for_each(|&end| distance[end as usize] = 0);
    }
    for _ in 0..NEAR {
        for edge in edges.iter() {
            let [a, b] = edge.ends.map(|end| end as usize);
            let next = distance[a].min(distance[b]) + 1;
            (distance[a], distance[b]) = (distance[a].min(next), distance[b].min(next));
        }
    }
    for edge in edges {
        let [a, b] = edge.ends.map(|end| distance[end as usize]);
        edge.inner_end = (a != b).then_some(usize::from(b > a));
    }
}
