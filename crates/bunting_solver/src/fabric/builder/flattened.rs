//! Removes what is left of pockets, folds and loops that a simplification has flattened.
//!
//! Where the last vertex between two layers is removed, these become two triangles with the same corners, one turned over,
//! on an edge that then has four. Both are removed, which joins the surface beneath them. What remains of a loop may be a
//! piece of a few triangles that hangs on the rest by one such edge. A pinned vertex at the tip of two such triangles is put
//! into the edge instead.

use std::collections::{BTreeMap, BTreeSet};

use crate::fabric::topology::ascending;

/// Number of triangles of a piece that is removed, as a part of those of the mesh. Smaller: such edges are left, and a mesh
/// with more vertices is taken. Larger: sleeves fall off.
const SMALL_PIECE: f32 = 0.05;

/// Removes flattened parts from triangles, three vertices each, that are merged into particles. Pinned vertices stay.
pub(super) fn remove_flattened(
    particle_of_vertex: &[u32],
    pinned: &BTreeSet<u32>,
    triangles: &mut Vec<[u32; 3]>,
) {
    let particles = |corners: &[u32; 3]| corners.map(|at| particle_of_vertex[at as usize]);
    triangles.retain(|corners| {
        let [a, b, c] = particles(corners);
        a != b && b != c && c != a
    });
    let mut of_corners: BTreeMap<[u32; 3], [Vec<usize>; 2]> = BTreeMap::new();
    for (index, corners) in triangles.iter().enumerate() {
        let corners = particles(corners);
        let mut sorted = corners;
        sorted.sort_unstable();
        let least = corners.iter().position(|&at| at == sorted[0]).unwrap_or(0);
        let is_turned = corners[(least + 1) % 3] != sorted[1];
        of_corners.entry(sorted).or_default()[usize::from(is_turned)].push(index);
    }
    let mut is_kept = vec![true; triangles.len()];
    let mut lost: Vec<u32> = Vec::new();
    for [front, back] in of_corners.into_values() {
        let pairs = front.len().min(back.len());
        // Of what is no pair, all but one lie on one another.
        let removed = |side: &[usize]| side.len().min(pairs.max(side.len().saturating_sub(1)));
        let [of_front, of_back] = [removed(&front), removed(&back)];
        for &index in front[..of_front].iter().chain(&back[..of_back]) {
            is_kept[index] = false;
            lost.extend(triangles[index].iter().filter(|vertex| pinned.contains(vertex)));
        }
    }
    let flattened: Vec<[u32; 3]> =
        (0..).zip(&*triangles).filter(|(at, _)| !is_kept[*at]).map(|(_, it)| *it).collect();
    remove_where(triangles, |index| !is_kept[index]);
    for vertex in lost {
        let particle = particle_of_vertex[vertex as usize];
        let is_at = |corners: &&[u32; 3]| particles(corners).contains(&particle);
        if triangles.iter().all(|corners| !is_at(&corners))
            && let Some(pair) = flattened.iter().find(is_at)
        {
            put_into_edge(&particles, vertex, pair, triangles);
        }
    }
    remove_small_pieces(&particles, triangles);
}

/// Puts a vertex into the edge of a removed triangle that lies across from it: each of the two triangles at this edge becomes
/// two.
fn put_into_edge(
    particles: &impl Fn(&[u32; 3]) -> [u32; 3],
    vertex: u32,
    removed: &[u32; 3],
    triangles: &mut Vec<[u32; 3]>,
) {
    let Some(at) = removed.iter().position(|&corner| corner == vertex) else { return };
    let corners = particles(removed);
    let (a, b) = (corners[(at + 1) % 3], corners[(at + 2) % 3]);
    let side = |index: usize, turn: usize| {
        let ends = particles(&triangles[index]);
        [ends[turn], ends[(turn + 1) % 3]]
    };
    let at_edge = |edge: [u32; 2]| {
        let sides = (0..triangles.len()).flat_map(|index| (0..3).map(move |turn| (index, turn)));
        let mut found = sides.filter(|&(index, turn)| side(index, turn) == edge);
        Some(found.next()?).filter(|_| found.next().is_none())
    };
    let Some((one, other)) = at_edge([a, b]).zip(at_edge([b, a])) else { return };
    for (index, turn) in [one, other] {
        let [from, to, tip] = [0, 1, 2].map(|by| triangles[index][(turn + by) % 3]);
        triangles[index] = [from, vertex, tip];
        triangles.push([vertex, to, tip]);
    }
}

fn remove_where(triangles: &mut Vec<[u32; 3]>, is_removed: impl Fn(usize) -> bool) {
    let mut index = 0;
    triangles.retain(|_| {
        index += 1;
        !is_removed(index - 1)
    });
}

/// Removes small pieces that hang on the rest by edges of more than two triangles.
fn remove_small_pieces(particles: &impl Fn(&[u32; 3]) -> [u32; 3], triangles: &mut Vec<[u32; 3]>) {
    let mut at_edges: BTreeMap<[u32; 2], Vec<usize>> = BTreeMap::new();
    for (index, corners) in triangles.iter().enumerate() {
        let [a, b, c] = particles(corners);
        for ends in [[a, b], [b, c], [c, a]] {
            at_edges.entry(ascending(ends)).or_default().push(index);
        }
    }
    let crowded: Vec<&Vec<usize>> = at_edges.values().filter(|at| at.len() > 2).collect();
    if crowded.is_empty() {
        return;
    }
    let mut neighbours = vec![Vec::new(); triangles.len()];
    for at in at_edges.values() {
        if let [one, other] = at[..] {
            neighbours[one].push(other);
            neighbours[other].push(one);
        }
    }
    let most = (SMALL_PIECE * triangles.len() as f32) as usize;
    let mut is_removed = vec![false; triangles.len()];
    for &first in crowded.into_iter().flatten() {
        if !is_removed[first]
            && let Some(piece) = piece_of(first, &neighbours, most)
        {
            piece.into_iter().for_each(|index| is_removed[index] = true);
        }
    }
    remove_where(triangles, |index| is_removed[index]);
}

/// The triangles that are joined with one; none if there are more than `most`.
fn piece_of(first: usize, neighbours: &[Vec<usize>], most: usize) -> Option<Vec<usize>> {
    let mut piece = vec![first];
    let mut next = 0;
    while next < piece.len() {
        for &neighbour in &neighbours[piece[next]] {
            if !piece.contains(&neighbour) {
                piece.push(neighbour);
            }
        }
        if piece.len() > most {
            return None;
        }
        next += 1;
    }
    Some(piece)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A fan of triangles around vertex 0, which is a disk without holes.
    fn disk(count: u32) -> Vec<[u32; 3]> {
        (1..=count).map(|at| [0, at, at % count + 1]).collect()
    }

    fn flattened(mut triangles: Vec<[u32; 3]>) -> Vec<[u32; 3]> {
        let each: Vec<u32> = (0..100).collect();
        remove_flattened(&each, &BTreeSet::new(), &mut triangles);
        triangles
    }

    #[test]
    fn a_sound_mesh_stays_as_it_is() {
        assert_eq!(flattened(disk(8)), disk(8));
    }

    #[test]
    fn a_flattened_pocket_is_removed_and_the_surface_beneath_is_joined() {
        let pocket = [[0, 1, 50], [1, 0, 50]];
        assert_eq!(flattened([&disk(8)[..], &pocket].concat()), disk(8));
        // Of triangles that lie on one another one stays.
        assert_eq!(flattened([&disk(8)[..], &disk(8)[..1]].concat()).len(), 8);
        assert_eq!(flattened([&disk(8)[..], &[[3, 3, 4]]].concat()), disk(8));
    }

    #[test]
    fn a_small_piece_that_hangs_on_an_edge_is_removed_and_a_large_one_stays() {
        let loop_of_four = [[0, 1, 95], [1, 96, 95], [96, 1, 0], [95, 96, 0]];
        let large = disk(90);
        assert_eq!(flattened([&large[..], &loop_of_four].concat()), large);
        let small = [&disk(8)[..], &loop_of_four].concat();
        assert_eq!(flattened(small.clone()), small);
    }

    #[test]
    fn a_pinned_tip_is_put_into_the_edge() {
        let each: Vec<u32> = (0..100).collect();
        let mut triangles = [&disk(8)[..], &[[0, 1, 50], [1, 0, 50]]].concat();
        remove_flattened(&each, &BTreeSet::from([50, 3]), &mut triangles);
        triangles.sort_unstable();
        // The edge from 0 to 1 had the triangles [0, 1, 2] and [0, 8, 1].
        let mut expected = disk(8);
        expected.retain(|corners| !(corners.contains(&0) && corners.contains(&1)));
        expected.extend([[0, 50, 2], [50, 1, 2], [1, 50, 8], [50, 0, 8]]);
        expected.sort_unstable();
        assert_eq!(triangles, expected);
    }

    #[test]
    fn vertices_of_one_particle_count_as_one() {
        // The two sides of a seam: vertices 60 and 61 lie at 0 and 1.
        let mut merged: Vec<u32> = (0..100).collect();
        (merged[60], merged[61]) = (0, 1);
        let mut triangles = [&disk(8)[..], &[[0, 1, 50], [61, 60, 50]]].concat();
        remove_flattened(&merged, &BTreeSet::new(), &mut triangles);
        assert_eq!(triangles, disk(8));
    }
}
