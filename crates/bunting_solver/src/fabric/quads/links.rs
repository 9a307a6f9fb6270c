//! The links of a net: each stands for half of the cells beside it, and has the moduli of the material in its own direction.

use std::collections::BTreeMap;

use super::Cell;
use super::lines::Line;
use crate::fabric::curved_links::MeanWarp;
use crate::fabric::edge_sums::EdgeSums;
use crate::fabric::laid_yarns::{Directions, Towards};
use crate::fabric::links::{LinkClass, LinkFamily, Links};
use crate::fabric::mesh::RestMesh;
use crate::fabric::topology::ascending;
use crate::fabric::yarns::{Yarn, Yarns};

/// Sums over the cells beside a link.
struct LinkSum {
    /// Width of cloth that the link stands for, m; of a diagonal the factor of the shear modulus.
    size: f32,
    is_diagonal: bool,
    /// cos² of the angle between the link, or the first side of its cell, and the warp.
    warp: MeanWarp,
}

/// The links along the sides of cells and across quads, with the width of cloth that each one along a side stands for, m.
pub(super) fn links(
    mesh: &RestMesh,
    cells: &[Cell],
    directions: &Directions,
) -> (Links, BTreeMap<[u32; 2], f32>) {
    let vector = |[from, to]: [u32; 2]| {
        let [from, to] = mesh.positions_of([from, to]);
        to - from
    };
    let mut sums = EdgeSums::new(mesh.positions.len());
    for cell in cells {
        let area = cell.area(&mesh.positions);
        let warp = directions.of_triangle(cell.triangles[0], Towards::Warp);
        let weft = directions.of_triangle(cell.triangles[0], Towards::Weft);
        let cos2 = |ends: [u32; 2]| {
            let [along, across] = [warp, weft].map(|axis| vector(ends).dot(axis).powi(2));
            along / (along + across).max(f32::MIN_POSITIVE)
        };
        let mut add = |ends: [u32; 2], size: f32, is_diagonal: bool, cos2: f32| {
            let none = || LinkSum { size: 0.0, is_diagonal, warp: MeanWarp::default() };
            let sum = sums.at(ends, none);
            // A diagonal may join two nodes that a side joins elsewhere.
            if sum.is_diagonal != is_diagonal {
                return;
            }
            sum.size += size;
            sum.warp.add(cos2);
        };
        let sides: Vec<[u32; 2]> = cell.sides().collect();
        let length = |side: usize| vector(sides[side]).length();
        match cell.nodes[..] {
            [a, b, c, d] => {
                for (side, &ends) in sides.iter().enumerate() {
                    // Opposite sides stand for the whole cell.
                    let width = area / (length(side) + length((side + 2) % 4));
                    add(ends, width, false, cos2(ends));
                }
                for ends in [[a, c], [b, d]] {
                    // G γ² A/2 in both diagonals, whose lengths change by γ A/d.
                    let factor = 0.5 * vector(ends).length_squared() / area;
                    add(ends, factor, true, cos2(sides[0]));
                }
            }
            _ => sides.iter().enumerate().for_each(|(side, &ends)| {
                // Three families of links share what two have elsewhere.
                let width = 2.0 / 3.0 * area / length(side);
                add(ends, width, false, cos2(ends));
            }),
        }
    }
    let mut widths = BTreeMap::new();
    let mut links = Vec::new();
    for (ends, sum) in sums.sorted() {
        let cos2 = sum.warp.mean();
        let family = match (sum.is_diagonal, cos2 > 0.5) {
            (true, _) => LinkFamily::Diagonal,
            (false, true) => LinkFamily::Warp,
            (false, false) => LinkFamily::Weft,
        };
        let coefficient = match sum.is_diagonal {
            true => sum.size,
            false => sum.size / vector(ends).length(),
        };
        if !sum.is_diagonal {
            widths.insert(ends, sum.size);
        }
        // Rows run along the side that is nearer to the warp.
        let class = LinkClass::of_family(family, coefficient, cos2.max(1.0 - cos2));
        links.push((ends, class, family));
    }
    (Links::of_classes(mesh, links.into_iter(), None), widths)
}

/// Lines without the links between pins, which are none, and all diagonals. Where a line turns from warp to weft, as along a round
/// border, another one begins: lines of one family seldom meet, so that few colours hold many lines each.
pub(super) fn yarns(mesh: &RestMesh, lines: &[Line], links: &Links) -> Yarns {
    let [sides, diagonals]: [Vec<_>; 2] = [false, true].map(|is_diagonal| {
        let list = (0..).zip(&links.list);
        list.filter(|(_, link)| (link.family == LinkFamily::Diagonal) == is_diagonal).collect()
    });
    let number: BTreeMap<[u32; 2], u32> =
        sides.iter().map(|(at, link)| (ascending(link.particles), *at)).collect();
    let mut list: Vec<Yarn> = Vec::new();
    for line in lines {
        let link = |ends: &[u32]| number.get(&ascending([ends[0], ends[1]])).copied();
        let mut steps: Vec<([u32; 2], Option<u32>)> =
            line.nodes.windows(2).map(|ends| ([ends[0], ends[1]], link(ends))).collect();
        let family = |link: u32| links.list[link as usize].family;
        let go_on = |(_, one): &([u32; 2], Option<u32>), (_, other): &([u32; 2], Option<u32>)| {
            one.zip(*other).is_some_and(|(one, other)| family(one) == family(other))
        };
        let last = steps.len() - 1;
        let begins = |at: &usize| !go_on(&steps[at.checked_sub(1).unwrap_or(last)], &steps[*at]);
        if let (true, Some(first)) = (line.is_ring(), (0..=last).find(begins)) {
            steps.rotate_left(first);
        }
        for run in steps.chunk_by(go_on).filter(|run| run[0].1.is_some()) {
            let ends = run.iter().map(|([_, to], _)| *to);
            list.push(Yarn {
                particles: core::iter::once(run[0].0[0]).chain(ends).collect(),
                links: run.iter().filter_map(|(_, link)| *link).collect(),
            });
        }
    }
    list.extend(
        diagonals
            .iter()
            .map(|(at, link)| Yarn { particles: link.particles.to_vec(), links: vec![*at] }),
    );
    Yarns::coloured_by_family(list, &links.list, mesh.positions.len())
}
