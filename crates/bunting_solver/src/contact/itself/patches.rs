//! Patches of neighbouring triangles, and the cells of which each consists.

use core::ops::Range;

use glam::Vec3;

use crate::fabric::Fabric;
use crate::simd::lane::Pack;
use crate::simd::registers::Pack8;

/// Most triangles of a patch. Fewer: more patches are compared in each substep. More: boxes of patches are large, and
/// patches bend more, so that more cells are compared.
const LARGEST_PATCH: usize = 32;

/// Most triangles of a cell, which are compared with another in lanes.
const LARGEST_CELL: usize = Pack8::WIDTH;

/// Neighbouring triangles, in cells.
#[derive(Clone, Debug)]
pub(in crate::contact) struct Patch {
    pub neighbours: Vec<Neighbour>,
    /// Indices of its cells.
    pub cells: Range<u32>,
}

/// A few neighbouring triangles of a patch.
#[derive(Clone, Debug)]
pub(in crate::contact) struct Cell {
    pub triangles: Range<u32>,
    pub particles: Vec<u32>,
    /// Corners of its triangles, one triangle in each lane; the last in those without one.
    pub corners: [[u32; LARGEST_CELL]; 3],
    pub neighbours: Vec<Neighbour>,
}

impl Patch {
    /// The patch among others, with larger indices of patches and cells.
    pub(in crate::contact) fn moved(&self, patches: u32, cells: u32) -> Self {
        Self {
            neighbours: self.neighbours.iter().map(|it| it.moved(patches)).collect(),
            cells: self.cells.start + cells..self.cells.end + cells,
        }
    }
}

impl Cell {
    /// The cell among others, with larger indices of cells, triangles and particles.
    pub(in crate::contact) fn moved(&self, cells: u32, triangles: u32, particles: u32) -> Self {
        let moved = |particle: u32| particle + particles;
        Self {
            triangles: self.triangles.start + triangles..self.triangles.end + triangles,
            particles: self.particles.iter().map(|&it| moved(it)).collect(),
            corners: self.corners.map(|corners| corners.map(moved)),
            neighbours: self.neighbours.iter().map(|it| it.moved(cells)).collect(),
        }
    }
}

/// The patches of a fabric, their cells, and the triangles in the order of these.
pub(in crate::contact) fn patches_of(fabric: &Fabric) -> (Vec<Patch>, Vec<Cell>, Vec<[u32; 3]>) {
    let (mut patches, mut cells) = (Vec::new(), Vec::new());
    for triangles in split(fabric, (0..fabric.triangles().len() as u32).collect(), LARGEST_PATCH) {
        let particles = particles_of(fabric, &triangles);
        let first = cells.len() as u32;
        cells.extend(split(fabric, triangles, LARGEST_CELL));
        patches.push((particles, first..cells.len() as u32));
    }
    let of_cells = cells.iter().map(|it| particles_of(fabric, it));
    let neighbours = self::neighbours(of_cells, fabric);
    let order = cells.iter().flatten();
    let triangles: Vec<[u32; 3]> =
        order.map(|&triangle| fabric.triangles()[triangle as usize]).collect();
    let mut begin = 0;
    let cells = cells.iter().zip(neighbours).map(|(of_cell, neighbours)| {
        let end = begin + of_cell.len() as u32;
        let range = core::mem::replace(&mut begin, end)..end;
        let of_lane = |lane: usize| triangles[range.start as usize + lane.min(of_cell.len() - 1)];
        let corners =
            core::array::from_fn(|corner| core::array::from_fn(|lane| of_lane(lane)[corner]));
        Cell { triangles: range, particles: particles_of(fabric, of_cell), corners, neighbours }
    });
    let cells: Vec<Cell> = cells.collect();
    let of_patches = patches.iter().map(|(particles, _)| particles.clone());
    let neighbours = self::neighbours(of_patches, fabric);
    let patches = patches.into_iter().zip(neighbours);
    let patches = patches.map(|((_, cells), neighbours)| Patch { neighbours, cells });
    (patches.collect(), cells, triangles)
}

/// A neighbour of a patch or a cell.
#[derive(Clone, Copy, Debug)]
pub(in crate::contact) struct Neighbour {
    pub index: u32,
    /// A neighbour of both along edges if they have a single particle in common. About a single particle they can turn.
    pub bridge: Option<u32>,
}

impl Neighbour {
    /// The neighbour among others, with larger indices.
    fn moved(self, by: u32) -> Self {
        Self { index: self.index + by, bridge: self.bridge.map(|bridge| bridge + by) }
    }
}

/// For each set of particles, its neighbours in the order of their indices: those with several common particles, and
/// those with one that have a bridge.
fn neighbours(
    sets: impl Iterator<Item = Vec<u32>> + Clone,
    fabric: &Fabric,
) -> Vec<Vec<Neighbour>> {
    let mut sets_at: Vec<Vec<u32>> = vec![Vec::new(); fabric.particle_count()];
    for (index, set) in sets.clone().enumerate() {
        set.iter().for_each(|&particle| sets_at[particle as usize].push(index as u32));
    }
    // For each set, the others with several common particles, and those with one.
    let touching: Vec<[Vec<u32>; 2]> = sets
        .enumerate()
        .map(|(index, set)| {
            let at = set.iter().flat_map(|&particle| &sets_at[particle as usize]);
            let mut all: Vec<u32> = at.copied().filter(|&it| it != index as u32).collect();
            all.sort_unstable();
            let (several, one): (Vec<&[u32]>, _) =
                all.chunk_by(|one, other| one == other).partition(|same| same.len() > 1);
            [several, one].map(|sets| sets.into_iter().map(|same| same[0]).collect())
        })
        .collect();
    touching
        .iter()
        .map(|[several, one]| {
            let along_edges = several.iter().map(|&index| Neighbour { index, bridge: None });
            let bridged = one.iter().filter_map(|&index| {
                let of_other = &touching[index as usize][0];
                let bridge = several.iter().copied().find(|bridge| of_other.contains(bridge));
                Some(Neighbour { index, bridge: Some(bridge?) })
            });
            let mut neighbours: Vec<Neighbour> = along_edges.chain(bridged).collect();
            neighbours.sort_unstable_by_key(|neighbour| neighbour.index);
            neighbours
        })
        .collect()
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

/// The parts of a few triangles that are connected along edges. About a single particle parts can turn upon each other while
/// each is flat.
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
