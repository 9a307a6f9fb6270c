//! The features of a fabric that may touch, and the patches in which they are looked up.

use std::collections::HashMap;

use crate::contact::itself::cell_groups::CellGroups;
use crate::contact::itself::features::{FeaturePack, FeaturesOfCell};
use crate::contact::itself::patches::{Cell, Patch, patches_of};
use crate::fabric::Fabric;

/// An edge and the triangles beside it.
#[derive(Clone, Copy, Debug)]
pub(in crate::contact) struct Edge {
    pub ends: [u32; 2],
    /// Length at rest, m.
    pub length: f32,
    /// The third corner of each triangle beside the edge; none beside a border.
    pub wings: [Option<u32>; 2],
    /// The index of the end that is farther from the border of the cloth, if the border is near.
    pub inner_end: Option<usize>,
}

/// The features of a fabric that may touch, and the patches in which they are looked up.
#[derive(Clone, Debug, Default)]
pub(crate) struct ContactMesh {
    /// Edges, in the order of the cells.
    pub(in crate::contact) edges: Vec<Edge>,
    pub(in crate::contact) patches: Vec<Patch>,
    pub(in crate::contact) cells: Vec<Cell>,
    pub(in crate::contact) cell_groups: CellGroups,
    /// For each cell, its features.
    pub(in crate::contact) features: Vec<FeaturesOfCell>,
    /// The features of all cells in packs.
    pub(in crate::contact) packs: Vec<FeaturePack>,
}

impl ContactMesh {
    pub fn of(fabric: &Fabric) -> Self {
        let (patches, cells, triangles) = patches_of(fabric);
        let mut all = Self { patches, ..Self::default() };
        let mut has_cell = vec![false; fabric.particle_count()];
        let mut index_of = HashMap::new();
        for cell in &cells {
            let triangles = &triangles[cell.triangles.start as usize..cell.triangles.end as usize];
            let (first_edge, mut particles) = (all.edges.len(), Vec::new());
            for triangle in triangles {
                for corner in 0..3 {
                    let particle = triangle[corner];
                    if !core::mem::replace(&mut has_cell[particle as usize], true) {
                        particles.push([particle; 3]);
                    }
                    let [from, to] = [particle, triangle[(corner + 1) % 3]];
                    let wing = triangle[(corner + 2) % 3];
                    match index_of.get(&[from.min(to), from.max(to)]) {
                        Some(&index) => all.edges[index as usize].wings[1] = Some(wing),
                        None => {
                            index_of.insert([from.min(to), from.max(to)], all.edges.len() as u32);
                            let [one, other] =
                                [from, to].map(|end| fabric.rest_positions()[end as usize]);
                            all.edges.push(Edge {
                                ends: [from, to],
                                length: one.distance(other),
                                wings: [Some(wing), None],
                                inner_end: None,
                            });
                        }
                    }
                }
            }
            let edges: Vec<[u32; 3]> = all.edges[first_edge..]
                .iter()
                .map(|it| [it.ends[0], it.ends[1], it.ends[1]])
                .collect();
            let triangles = FeaturePack::add(triangles, 0, &mut all.packs);
            let edges = FeaturePack::add(&edges, first_edge as u32, &mut all.packs);
            let particles = FeaturePack::add(&particles, 0, &mut all.packs);
            all.features.push(FeaturesOfCell { triangles, edges, particles });
        }
        set_inner_ends(&mut all.edges, fabric.particle_count());
        all.cell_groups = CellGroups::of(&cells);
        all.cells = cells;
        all
    }

    /// The features of several cloths, the particles of each after those of the one before.
    pub(in crate::contact) fn joined<'a>(parts: impl Iterator<Item = (&'a Self, u32)>) -> Self {
        let mut all = Self::default();
        let mut first = 0;
        for (part, particles) in parts {
            let [edges, patches, cells, packs] =
                [all.edges.len(), all.patches.len(), all.cells.len(), all.packs.len()]
                    .map(|count| count as u32);
            let moved = |particle: u32| particle + first;
            all.edges.extend(part.edges.iter().map(|edge| Edge {
                ends: edge.ends.map(moved),
                wings: edge.wings.map(|wing| wing.map(moved)),
                ..*edge
            }));
            all.patches.extend(part.patches.iter().map(|patch| patch.moved(patches, cells, first)));
            all.cells.extend(part.cells.iter().map(|cell| cell.moved(cells, first)));
            all.features.extend(part.features.iter().map(|it| it.moved(packs)));
            all.packs.extend(part.packs.iter().map(|pack| pack.moved(edges, first)));
            first += particles;
        }
        all.cell_groups = CellGroups::of(&all.cells);
        all
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
