//! Places of nodes beside the vertices of a mesh of quads, so that lines through these do not zigzag.

use std::collections::BTreeSet;

use glam::DVec3;

use super::source::Source;

/// How often each node moves. Fewer: lines wander within some cells.
const ROUNDS: usize = 50;

/// Part of the way to the middle between its neighbours that a node moves.
const PART: f64 = 0.5;

/// The places of nodes, m, that begin at the vertices and move within the surface towards the middles between those before and after
/// them, given each three consecutive nodes of lines. Pins stay, and nodes of the border move along it.
pub(super) fn faired(source: &Source, threes: &[[u32; 3]]) -> Vec<DVec3> {
    let border = source.edges.iter().filter(|edge| edge.other_side.is_none());
    let border: BTreeSet<u32> = border.flat_map(|edge| edge.ends).collect();
    let moves_node = |three: &&[u32; 3]| {
        let [before, at, after] = three;
        let runs_along = border.contains(before) && border.contains(after);
        !source.mesh.is_pinned(*at) && (!border.contains(at) || runs_along)
    };
    let threes: Vec<&[u32; 3]> = threes.iter().filter(moves_node).collect();
    let mut places = source.positions.clone();
    for _ in 0..ROUNDS {
        let mut sums = vec![(DVec3::ZERO, 0.0); places.len()];
        for three in &threes {
            let [before, at, after] = three.map(|at| places[at as usize]);
            let (sum, count) = &mut sums[three[1] as usize];
            *sum += before.midpoint(after) - at;
            *count += 1.0;
        }
        let moved = places.iter_mut().zip(sums).zip(&source.normals);
        for ((place, (sum, count)), normal) in moved.filter(|((_, (_, count)), _)| *count > 0.0) {
            *place += (sum - *normal * sum.dot(*normal)) * (PART / count);
        }
    }
    places
}
