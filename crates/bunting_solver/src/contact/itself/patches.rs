//! Patches of neighbouring triangles, and the cells of which each consists.

use core::ops::Range;
use std::collections::HashMap;

use glam::Vec3;

use crate::fabric::Fabric;
use crate::simd::lane::Pack;
use crate::simd::registers::Pack8;

/// Most triangles of a patch. Fewer: more patches are compared in each substep. More: boxes of patches are large, and
/// patches bend more, so that more cells are compared.
const LARGEST_PATCH: usize = 32;

/// Most triangles of a cell, which are compared with another in lanes.
pub(in crate::contact) const LARGEST_CELL: usize = Pack8::WIDTH;

/// Neighbouring triangles, in cells.
#[derive(Clone, Debug)]
pub(in crate::contact) struct Patch {
    pub neighbours: Vec<Neighbour>,
    /// Indices of its cells.
    pub cells: Range<u32>,
    pub particles: Vec<u32>,
}

/// A few neighbouring triangles of a patch.
#[derive(Clone, Debug)]
pub(in crate::contact) struct Cell {
    pub triangles: Range<u32>,
    pub particles: Vec<u32>,
    /// Length of its longest edge at rest, m.
    pub longest_edge: f32,
    /// Corners of its triangles, one triangle in each lane; the last in those without one.
    pub corners: [[u32; LARGEST_CELL]; 3],
    pub neighbours: Vec<Neighbour>,
}

impl Patch {
    /// The patch among others, with larger indices of patches, cells and particles.
    pub(in crate::contact) fn moved(&self, patches: u32, cells: u32, particles: u32) -> Self {
        Self {
            neighbours: self.neighbours.iter().map(|it| it.moved(patches)).collect(),
            cells: self.cells.start + cells..self.cells.end + cells,
            particles: self.particles.iter().map(|&it| it + particles).collect(),
        }
    }
}

impl Cell {
    /// The cell among others, with larger indices of cells and particles.
    pub(in crate::contact) fn moved(&self, cells: u32, particles: u32) -> Self {
        let moved = |particle: u32| particle + particles;
        Self {
            triangles: self.triangles.clone(),
            particles: self.particles.iter().map(|&it| moved(it)).collect(),
            longest_edge: self.longest_edge,
            corners: self.corners.map(|corners| corners.map(moved)),
            neighbours: self.neighbours.iter().map(|it| it.moved(cells)).collect(),
        }
    }
}

/// The patches of a fabric, their cells, and the triangles in the order of these.
pub(in crate::contact) fn patches_of(fabric: &Fabric) -> (Vec<Patch>, Vec<Cell>, Vec<[u32; 3]>) {
    let (mut patches, mut cells) = (Vec::new(), Vec::new());
    for triangles in split(fabric, (0..fabric.triangles().len() as u32).collect(), LARGEST_PATCH) {
        let first = cells.len() as u32;
        cells.extend(split(fabric, triangles.clone(), LARGEST_CELL));
        patches.push((triangles, first..cells.len() as u32));
    }
    let of_cells = neighbours(cells.iter(), fabric);
    let order = cells.iter().flatten();
    let triangles: Vec<[u32; 3]> =
        order.map(|&triangle| fabric.triangles()[triangle as usize]).collect();
    let mut begin = 0;
    let cells = cells.iter().zip(of_cells).map(|(of_cell, neighbours)| {
        let end = begin + of_cell.len() as u32;
        let range = core::mem::replace(&mut begin, end)..end;
        let of_lane = |lane: usize| triangles[range.start as usize + lane.min(of_cell.len() - 1)];
        let corners =
            core::array::from_fn(|corner| core::array::from_fn(|lane| of_lane(lane)[corner]));
        Cell {
            triangles: range,
            particles: particles_of(fabric, of_cell),
            longest_edge: longest_edge(fabric, of_cell),
            corners,
            neighbours,
        }
    });
    let cells: Vec<Cell> = cells.collect();
    let of_patches = neighbours(patches.iter().map(|(triangles, _)| triangles), fabric);
    let patches = patches.into_iter().zip(of_patches);
    let patches = patches.map(|((triangles, cells), neighbours)| Patch {
        neighbours,
        cells,
        particles: particles_of(fabric, &triangles),
    });
    (patches.collect(), cells, triangles)
}

/// A neighbour of a patch or a cell.
#[derive(Clone, Copy, Debug)]
pub(in crate::contact) struct Neighbour {
    pub index: u32,
    /// A neighbour of both along edges if they have no edge in common. About single particles they can turn.
    pub bridge: Option<u32>,
}

impl Neighbour {
    /// The neighbour among others, with larger indices.
    fn moved(self, by: u32) -> Self {
        Self { index: self.index + by, bridge: self.bridge.map(|bridge| bridge + by) }
    }
}

/// For each set of triangles, its neighbours in the order of their indices: those along edges, and those at particles
/// that have a bridge.
fn neighbours<'a>(
    sets: impl Iterator<Item = &'a Vec<u32>> + Clone,
    fabric: &Fabric,
) -> Vec<Vec<Neighbour>> {
    let mut at_particles: Vec<Vec<u32>> = vec![Vec::new(); fabric.particle_count()];
    let mut at_edges: HashMap<[u32; 2], Vec<u32>> = HashMap::new();
    for (index, set) in sets.clone().enumerate() {
        for &particle in &particles_of(fabric, set) {
            at_particles[particle as usize].push(index as u32);
        }
        for edge in edges_of(fabric, set) {
            at_edges.entry(edge).or_default().push(index as u32);
        }
    }
    // For each set, the others along edges, and those at particles alone.
    let touching: Vec<[Vec<u32>; 2]> = sets
        .enumerate()
        .map(|(index, set)| {
            let others = |all: Vec<u32>| {
                sorted(all.into_iter().filter(|&other| other != index as u32).collect())
            };
            let along = edges_of(fabric, set);
            let along = others(along.flat_map(|edge| at_edges[&edge].iter().copied()).collect());
            let at = particles_of(fabric, set).into_iter();
            let at = at.flat_map(|particle| at_particles[particle as usize].iter().copied());
            let at = others(at.filter(|other| along.binary_search(other).is_err()).collect());
            [along, at]
        })
        .collect();
    touching
        .iter()
        .map(|[along, at]| {
            let along_edges = along.iter().map(|&index| Neighbour { index, bridge: None });
            let bridged = at.iter().filter_map(|&index| {
                let of_other = &touching[index as usize][0];
                let bridge = along.iter().copied().find(|bridge| of_other.contains(bridge));
                Some(Neighbour { index, bridge: Some(bridge?) })
            });
            let mut neighbours: Vec<Neighbour> = along_edges.chain(bridged).collect();
            neighbours.sort_unstable_by_key(|neighbour| neighbour.index);
            neighbours
        })
        .collect()
}

/// Edges of some triangles, those inside twice.
fn edges_of<'a>(fabric: &'a Fabric, triangles: &'a [u32]) -> impl Iterator<Item = [u32; 2]> + 'a {
    let sides = |[a, b, c]: [u32; 3]| [[a, b], [b, c], [c, a]];
    let edges = triangles.iter().flat_map(move |&it| sides(fabric.triangles()[it as usize]));
    edges.map(|[a, b]| [a.min(b), a.max(b)])
}

/// Length of the longest edge of some triangles at rest, m.
fn longest_edge(fabric: &Fabric, triangles: &[u32]) -> f32 {
    let rest = |particle: u32| fabric.rest_positions()[particle as usize];
    let lengths = edges_of(fabric, triangles).map(|[a, b]| rest(a).distance(rest(b)));
    lengths.fold(0.0, f32::max)
}

/// Particles of some triangles, in order.
fn particles_of(fabric: &Fabric, triangles: &[u32]) -> Vec<u32> {
    sorted(triangles.iter().flat_map(|&it| fabric.triangles()[it as usize]).collect())
}

fn sorted(mut values: Vec<u32>) -> Vec<u32> {
    values.sort_unstable();
    values.dedup();
    values
}

/// Splits triangles into connected parts of at most `largest` triangles, each across the longest side of the box of the
/// triangles' middles at rest.
fn split(fabric: &Fabric, triangles: Vec<u32>, largest: usize) -> Vec<Vec<u32>> {
    let rest = fabric.rest_positions();
    let middle = |triangle: u32| -> Vec3 {
        fabric.triangles()[triangle as usize].iter().map(|&corner| rest[corner as usize]).sum()
    };
    let mut parts = Vec::new();
    let mut waiting = vec![triangles];
    while let Some(mut triangles) = waiting.pop() {
        if triangles.len() <= largest {
            parts.extend(connected(fabric, triangles));
            continue;
        }
        let middles = || triangles.iter().map(|&triangle| middle(triangle));
        let low = middles().fold(Vec3::INFINITY, Vec3::min);
        let high = middles().fold(Vec3::NEG_INFINITY, Vec3::max);
        let axis = (high - low).max_position();
        triangles.sort_by(|&one, &other| middle(one)[axis].total_cmp(&middle(other)[axis]));
        let half = triangles.split_off(triangles.len() / 2);
        waiting.extend([half, triangles]);
    }
    parts
}

/// The parts of a few triangles that are connected along edges. About a single particle parts can turn upon each other
/// while each is flat.
fn connected(fabric: &Fabric, mut triangles: Vec<u32>) -> Vec<Vec<u32>> {
    let corners = |triangle: u32| fabric.triangles()[triangle as usize];
    let share_edge = |one: u32, other: u32| {
        corners(one).iter().filter(|corner| corners(other).contains(corner)).count() > 1
    };
    let mut parts = Vec::new();
    while let Some(first) = triangles.pop() {
        let mut part = vec![first];
        loop {
            let joins = |triangle: &mut u32| part.iter().any(|&it| share_edge(it, *triangle));
            let Some(next) = triangles.extract_if(.., joins).next() else { break };
            part.push(next);
        }
        part.sort_unstable();
        parts.push(part);
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fabric::{FabricBuilder, Grid};

    #[test]
    fn cells_and_patches_are_connected_along_edges() {
        let fabric = FabricBuilder::grid(Grid::new(21, 41, 0.5, 1.0)).build().expect("a good grid");
        let (patches, cells, triangles) = patches_of(&fabric);
        let is_one = |part: Range<u32>| {
            let part: Vec<[u32; 3]> = triangles[part.start as usize..part.end as usize].to_vec();
            let mut reached = vec![part[0]];
            let mut next = 0;
            while let Some(&from) = reached.get(next) {
                let beside = |it: &&[u32; 3]| it.iter().filter(|at| from.contains(at)).count() == 2;
                let new: Vec<_> = { part.iter().filter(beside).copied() }
                    .filter(|it| !reached.contains(it))
                    .collect();
                reached.extend(new);
                next += 1;
            }
            reached.len() == part.len()
        };
        assert!(cells.iter().all(|cell| is_one(cell.triangles.clone())));
        assert!(patches.iter().all(|patch| {
            let [first, last] = [patch.cells.start, patch.cells.end - 1];
            is_one(cells[first as usize].triangles.start..cells[last as usize].triangles.end)
        }));
    }
}
