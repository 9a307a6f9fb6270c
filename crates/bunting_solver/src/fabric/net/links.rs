//! The links of a net: each stands for half of the cells beside it, and has the moduli of the material in its own direction.

use std::collections::BTreeMap;

use super::cell::Cell;
use super::lines::Line;
use crate::fabric::directions::{Directions, Towards};
use crate::fabric::edge_sums::EdgeSums;
use crate::fabric::links::{Link, LinkClass, LinkFamily, Links};
use crate::fabric::mesh::RestMesh;
use crate::fabric::regions::Variation;
use crate::fabric::topology::ascending;
use crate::fabric::yarns::{Yarn, Yarns};

/// Least difference of cos² of an angle to the warp in two cells of pieces with different warps. Larger: links at seams shear as if
/// they were cut on the bias.
const UNLIKE_WARPS: f32 = 0.2;

/// Least cosine of the angle by which a line turns where it goes on across a seam. Smaller: lines go on around corners.
const STRAIGHT: f32 = 0.92;

/// The mean of cos² of an angle to the warp over the cells beside a link. At seams a link has the warp of one piece: in between
/// there would be cloth that is cut on the bias.
#[derive(Clone, Copy, Debug, Default)]
struct MeanWarp {
    sum: f32,
    cells: f32,
}

impl MeanWarp {
    /// Counts a cell, unless its piece has another warp than those counted before.
    fn add(&mut self, cos2: f32) {
        if self.cells == 0.0 || (self.mean() - cos2).abs() < UNLIKE_WARPS {
            self.sum += cos2;
            self.cells += 1.0;
        }
    }

    fn mean(&self) -> f32 {
        self.sum / self.cells
    }
}

/// Sums over the cells beside a link.
struct LinkSum {
    /// Width of cloth that the link stands for, m; of a diagonal the factor of the shear modulus.
    size: f32,
    is_diagonal: bool,
    /// cos² of the angle between the link, or the first side of its cell, and the warp.
    warp: MeanWarp,
}

/// What is known of a side of cells.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side {
    /// Width of cloth that its link stands for, m.
    pub width: f32,
    /// cos² of its angle to the warp.
    pub warp_cos2: f32,
}

impl Side {
    /// The direction of the texture that it is nearer to.
    pub fn family(&self) -> LinkFamily {
        if self.warp_cos2 > 0.5 { LinkFamily::Warp } else { LinkFamily::Weft }
    }
}

/// A link before it is listed.
pub(super) struct Unlisted {
    ends: [u32; 2],
    class: LinkClass,
    /// Whether it is a diagonal of a quad.
    is_diagonal: bool,
}

/// The links along the sides of cells and across quads, and what is known of each side.
pub(super) fn links(
    mesh: &RestMesh,
    cells: &[Cell],
    directions: &Directions,
    variation: &Variation,
) -> (Vec<Unlisted>, BTreeMap<[u32; 2], Side>) {
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
    let mut sides = BTreeMap::new();
    let mut links = Vec::new();
    for (ends, LinkSum { size, is_diagonal, warp }) in sums.sorted() {
        let warp_cos2 = warp.mean();
        let side = Side { width: size, warp_cos2 };
        let (family, coefficient) = match is_diagonal {
            true => (LinkFamily::Diagonal, size),
            false => (side.family(), size / vector(ends).length()),
        };
        if !is_diagonal {
            sides.insert(ends, side);
        }
        // Rows run along the side that is nearer to the warp.
        let warp_cos2 = warp_cos2.max(1.0 - warp_cos2);
        let factor = variation.of_link(ends);
        let class = LinkClass { factor, ..LinkClass::of_family(family, coefficient, warp_cos2) };
        links.push(Unlisted { ends, class, is_diagonal });
    }
    (links, sides)
}

/// Lists links and the yarns along lines, each with the family that most of its links have. Links between pins are none, and diagonals
/// are yarns by themselves.
pub(super) fn listed(
    mesh: &RestMesh,
    lines: &[Line],
    links: Vec<Unlisted>,
    sides: &BTreeMap<[u32; 2], Side>,
) -> (Links, Yarns) {
    let runs = runs(mesh, lines, sides);
    let mut families: BTreeMap<[u32; 2], LinkFamily> = BTreeMap::new();
    for run in &runs {
        let of_warp = run.iter().filter(|ends| family(sides, ends) == LinkFamily::Warp).count();
        let is_warp = 2 * of_warp > run.len();
        let family = if is_warp { LinkFamily::Warp } else { LinkFamily::Weft };
        families.extend(run.iter().map(|ends| (ascending(*ends), family)));
    }
    let with_family = links.into_iter().map(|Unlisted { ends, class, is_diagonal }| {
        let family = match is_diagonal {
            true => LinkFamily::Diagonal,
            false => families.get(&ends).copied().unwrap_or(LinkFamily::Weft),
        };
        (ends, class, family)
    });
    let links = Links::of_classes(mesh, with_family);
    let listed = || (0..).zip(&links.list);
    let is_diagonal = |link: &Link| link.family == LinkFamily::Diagonal;
    let number: BTreeMap<[u32; 2], u32> = listed()
        .filter(|(_, link)| !is_diagonal(link))
        .map(|(at, link)| (ascending(link.particles), at))
        .collect();
    let of_run = |run: &Vec<[u32; 2]>| Yarn {
        particles: core::iter::once(run[0][0]).chain(run.iter().map(|[_, to]| *to)).collect(),
        links: run.iter().filter_map(|ends| number.get(&ascending(*ends)).copied()).collect(),
    };
    let diagonals = listed().filter(|(_, link)| is_diagonal(link));
    let diagonals =
        diagonals.map(|(at, link)| Yarn { particles: link.particles.to_vec(), links: vec![at] });
    let yarns = runs.iter().map(of_run).chain(diagonals).collect();
    let yarns = Yarns::coloured_by_family(yarns, &links.list, mesh.positions.len());
    (links, yarns)
}

fn family(sides: &BTreeMap<[u32; 2], Side>, ends: &[u32; 2]) -> LinkFamily {
    sides.get(&ascending(*ends)).map_or(LinkFamily::Weft, Side::family)
}

/// The parts of lines that are solved at once, as the ends of their links. Pins part lines. Where a line turns from warp to weft, as
/// along a round border, another part begins: parts of one family seldom meet, so that few colours hold many of them each. Where the
/// texture turns, as at a seam of two pieces, the line goes on: a load that it had to hand over there would take many passes.
fn runs(mesh: &RestMesh, lines: &[Line], sides: &BTreeMap<[u32; 2], Side>) -> Vec<Vec<[u32; 2]>> {
    // A side whose ends a diagonal joins already is none.
    let is_link = |ends: &[u32; 2]| {
        let is_free = !ends.iter().all(|end| mesh.is_pinned(*end));
        is_free && sides.contains_key(&ascending(*ends))
    };
    let go_on = |one: &[u32; 2], other: &[u32; 2]| {
        let seam = || {
            let [one, other] = [one, other].map(|ends| sides.get(&ascending(*ends)));
            let apart = one.zip(other).map(|(one, other)| one.warp_cos2 - other.warp_cos2);
            apart.is_some_and(|apart| apart.abs() > UNLIKE_WARPS)
        };
        let is_straight = || {
            let [a, b, c] = mesh.positions_of([one[0], one[1], other[1]]);
            (b - a).normalize_or_zero().dot((c - b).normalize_or_zero()) > STRAIGHT
        };
        let is_of_one = family(sides, one) == family(sides, other) || (is_straight() && seam());
        is_link(one) && is_link(other) && is_of_one
    };
    let mut runs = Vec::new();
    for line in lines {
        let mut steps: Vec<[u32; 2]> =
            line.nodes.windows(2).map(|ends| [ends[0], ends[1]]).collect();
        let last = steps.len() - 1;
        let begins = |at: &usize| !go_on(&steps[at.checked_sub(1).unwrap_or(last)], &steps[*at]);
        if let (true, Some(first)) = (line.is_ring(), (0..=last).find(begins)) {
            steps.rotate_left(first);
        }
        let of_line = steps.chunk_by(go_on).filter(|run| is_link(&run[0]));
        runs.extend(of_line.map(<[_]>::to_vec));
    }
    runs
}
