//! Bending of a net along its lines.

use core::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet};

use super::cell::Cell;
use super::lines::Line;
use super::links::Side;
use crate::fabric::bending::{BendLine, BendProfile, Bending};
use crate::fabric::directions::{Directions, Towards};
use crate::fabric::mesh::RestMesh;
use crate::fabric::regions::Variation;
use crate::fabric::rest_bends::RestBends;
use crate::fabric::topology::ascending;

/// What the lines of a net are at each node: its row is the line that runs more along the warp, its column the other one.
struct Crossings {
    /// Number of the line that is the node's row, and of that which is its column.
    lines: Vec<[Option<usize>; 2]>,
    /// The nodes before and after it in its row, and above and below it in its column: the node itself where there is none.
    neighbours: Vec<[u32; 4]>,
}

/// The lines along which a net bends, given its sides and how its material varies, and its second differences at rest.
pub(super) fn bending(
    mesh: &RestMesh,
    cells: &[Cell],
    lines: &[Line],
    directions: &Directions,
    (sides, variation): (&BTreeMap<[u32; 2], Side>, &Variation),
) -> (Bending, RestBends) {
    let crossings = crossings(mesh, cells, lines, directions);
    let mut bending = Bending::default();
    for (number, line) in lines.iter().enumerate() {
        for nodes in open_parts(line) {
            let kind = |at: usize| {
                let at = crossings.lines[nodes[at] as usize];
                at.iter().position(|line| *line == Some(number))
            };
            // Nodes between which a row becomes a column begin a line of their own.
            let inner: Vec<usize> = (1..nodes.len() - 1).collect();
            for run in inner.chunk_by(|one, other| kind(*one) == kind(*other)) {
                let [first, last] = [run[0], run[run.len() - 1]];
                if let Some(kind) = kind(first) {
                    let particles = nodes[first - 1..=last + 1].to_vec();
                    let sizes = sizes(mesh, &particles, sides);
                    let inverse_areas = &mesh.inverse_areas;
                    let profile = BendProfile::new(&particles, &sizes, inverse_areas, variation);
                    let profile_index = bending.profiles.len() as u32;
                    bending.profiles.push(profile);
                    let is_row = kind == 0;
                    bending.lines.push(BendLine { is_row, particles, profile: profile_index });
                }
            }
        }
    }
    // Lines of like length are solved side by side.
    bending.lines.sort_by_key(|line| (!line.is_row, Reverse(line.particles.len())));
    let rest = RestBends::of(&mesh.positions, crossings.neighbours);
    (bending, rest)
}

/// A line, or a ring in two parts, each of which bends at the nodes at which the other one ends.
fn open_parts(line: &Line) -> Vec<Vec<u32>> {
    match line.nodes[..] {
        [first, second, .., before_last, last, _] if line.is_ring() && line.nodes.len() > 4 => {
            let around = line.nodes[..line.nodes.len() - 1].to_vec();
            vec![around, vec![before_last, last, first, second]]
        }
        // A ring of three links hardly bends.
        _ if line.is_ring() => Vec::new(),
        _ => vec![line.nodes.clone()],
    }
}

/// The mean length of the links beside each node of a line, m, and the mean width of cloth that they stand for, m.
fn sizes(mesh: &RestMesh, nodes: &[u32], sides: &BTreeMap<[u32; 2], Side>) -> Vec<(f32, f32)> {
    let of_link = |ends: &[u32]| {
        let [one, other] = mesh.positions_of([ends[0], ends[1]]);
        (
            one.distance(other),
            sides.get(&ascending([ends[0], ends[1]])).map_or(0.0, |side| side.width),
        )
    };
    let links: Vec<(f32, f32)> = nodes.windows(2).map(of_link).collect();
    let of_node = |at: usize| {
        let one = links[at.saturating_sub(1)];
        let other = links[at.min(links.len() - 1)];
        (0.5 * (one.0 + other.0), 0.5 * (one.1 + other.1))
    };
    (0..nodes.len()).map(of_node).collect()
}

fn crossings(
    mesh: &RestMesh,
    cells: &[Cell],
    lines: &[Line],
    directions: &Directions,
) -> Crossings {
    let count = mesh.positions.len();
    let mut beside = vec![BTreeSet::new(); count];
    let mut triangle = vec![0; count];
    for cell in cells {
        for [one, other] in cell.sides() {
            beside[one as usize].insert(other);
            beside[other as usize].insert(one);
            triangle[one as usize] = cell.triangles[0];
        }
    }
    let mut passing: Vec<Vec<(usize, [u32; 2])>> = vec![Vec::new(); count];
    for (number, line) in lines.iter().enumerate() {
        for [before, at, after] in line.threes() {
            passing[at as usize].push((number, [before, after]));
        }
    }
    let of_node = |node: usize| {
        let here = node as u32;
        // How much more two nodes lie apart along the warp than along the weft.
        let along_warp = |[from, to]: [u32; 2]| {
            let [from, to] = mesh.positions_of([from, to]);
            let along = |towards| {
                directions.of_triangle(triangle[node], towards).dot((to - from).normalize()).abs()
            };
            along(Towards::Warp) - along(Towards::Weft)
        };
        let mut of_node = passing[node].clone();
        of_node.sort_by(|one, other| along_warp(other.1).total_cmp(&along_warp(one.1)));
        match of_node[..] {
            // Each link at a corner ends there.
            [] => {
                let mut near: Vec<u32> = beside[node].iter().copied().collect();
                near.sort_by(|one, other| {
                    along_warp([here, *other]).total_cmp(&along_warp([here, *one]))
                });
                let [first, last] = [near.first(), near.last()].map(|at| *at.unwrap_or(&here));
                ([None; 2], [here, first, here, last])
            }
            [(line, ends @ [before, after])] => {
                let other = beside[node].iter().find(|at| !ends.contains(at));
                let other = *other.unwrap_or(&here);
                match along_warp(ends) > 0.0 {
                    true => ([Some(line), None], [before, after, here, other]),
                    false => ([None, Some(line)], [here, other, before, after]),
                }
            }
            [(row, [before, after]), .., (column, [above, below])] => {
                ([Some(row), Some(column)], [before, after, above, below])
            }
        }
    };
    let (lines, neighbours) = (0..count).map(of_node).unzip();
    Crossings { lines, neighbours }
}
