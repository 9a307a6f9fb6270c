//! Yarns that are laid across the triangles of a mesh.
//!
//! Links along the edges of an irregular mesh are no paths along which a load runs: chains of them are short and
//! zigzag, and what they leave to relaxation converges slowly. A mesh that has no background grid therefore gets yarns
//! that run straight across its triangles, along warp, weft and both diagonals. A yarn's nodes are its crossings with
//! edges, each of which moves with the two particles at the ends of its edge; links between them are as stiff as the
//! material is, in the width of cloth that the yarn stands for.
//!
//! `directions` finds warp and weft in each triangle, `faces` walks across triangles, `lay` places the yarns and `near`
//! finds those beside them; `widths` measures how much cloth each link stands for.

mod directions;
mod faces;
mod lay;
mod near;
#[cfg(test)]
mod tests;
mod widths;

use core::cmp::Reverse;
use std::collections::HashMap;

use glam::Vec3;

use self::faces::Crossing;
use self::lay::{Layer, Line, Piece};
use self::widths::{Spacing, Widths};
use super::colour::{Colours, colour_up_to};
use super::links::LinkFamily;
use super::mesh::{RestMesh, Surface};

pub(in crate::fabric) use self::directions::Directions;
pub(in crate::fabric) use self::faces::Faces;
pub(in crate::fabric) use self::lay::Towards;

/// Least distance of two nodes along a yarn, in mean distances of crossings. Smaller: more links, which differ more in
/// length and stiffness, so that the solution of one family disturbs that of the others. Larger: yarns no longer see
/// all that the mesh can do, and it stretches too far.
const LEAST_LINK: f32 = 0.65;

/// Links between which particles couple the rows of a yarn's system: each with the next ones, up to this many.
pub(crate) const BAND: usize = 3;

/// Yarns that a cloth that is alone solves at once, in the lanes of a vector.
pub(crate) const YARNS_AT_ONCE: usize = 8;

/// A point on an edge that moves with the particles at its ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Node {
    pub particles: [u32; 2],
    /// Parts with which the particles move the node.
    pub parts: [f32; 2],
}

/// A link between two nodes of a laid yarn.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LaidLink {
    pub family: LinkFamily,
    /// Distance of its nodes at rest, m.
    pub rest_length: f32,
    /// Length at rest over the width of cloth that the link stands for: its compliance in units of one over the
    /// modulus.
    pub slenderness: f32,
    /// Numbers of the [`Coupling`]s of its row of the system with that of the k-th link before it, k = 0 to [`BAND`].
    pub couplings: [u8; BAND + 1],
}

/// A particle that moves two links of a yarn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Coupling {
    pub particle: u32,
    /// Product of the factors with which the particle moves the two vectors between the links' nodes.
    pub factor: f32,
}

/// A yarn across triangles.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LaidYarn {
    /// One more than links.
    pub nodes: Vec<Node>,
    pub links: Vec<LaidLink>,
    /// Couplings, row by row, each row beginning with the link's own.
    pub couplings: Vec<Coupling>,
}

impl AsRef<[Node]> for LaidYarn {
    #[inline(always)]
    fn as_ref(&self) -> &[Node] {
        &self.nodes
    }
}

/// All yarns laid across a mesh, colour by colour, the longest of each colour first.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct LaidYarns {
    pub list: Vec<LaidYarn>,
    /// Yarns of one colour share no particle. A colour has no more than [`YARNS_AT_ONCE`].
    pub colours: Colours,
    /// Least distance of yarns, m.
    pub least_spacing: f32,
}

impl LaidYarns {
    /// Lays yarns across a mesh.
    pub(in crate::fabric) fn of(mesh: &RestMesh, surface: &Surface) -> Self {
        let faces = Faces::new(&mesh.positions, &mesh.triangles, &surface.edges);
        let directions = Directions::of(&faces, &surface.corner_uv);
        let spacings = Towards::ALL.map(|towards| {
            Spacing::of(mesh, surface, &faces, |at| directions.of_triangle(at, towards))
        });
        let distance = spacings[0].of_lines.iter().sum::<f32>() / faces.count() as f32;
        let mut layer = Layer::new(&faces, &directions, distance);
        let lines = Towards::ALL.into_iter().zip(&spacings).map(|(towards, spacing)| {
            let lines = layer.lay(towards, &spacing.of_lines);
            lines.into_iter().map(move |line| (line, &spacing.of_crossings[..]))
        });
        let lines: Vec<(Line, &[f32])> = lines.flatten().collect();
        let widths = Widths::of(mesh, surface, lines.iter().map(|(line, _)| line));
        let yarns = lines.iter().flat_map(|(line, spacing)| yarns_of(line, mesh, spacing, &widths));
        let along_sides = spacings[..2].iter().flat_map(|spacing| &spacing.of_lines);
        let least_spacing = along_sides.copied().fold(f32::INFINITY, f32::min);
        let (list, colours) = coloured(yarns.collect(), mesh.positions.len());
        Self { list, colours, least_spacing }
    }

    /// Number of links in the longest yarn.
    pub fn longest(&self) -> usize {
        self.list.iter().map(|yarn| yarn.links.len()).max().unwrap_or(0)
    }

    /// Number of links.
    pub fn link_count(&self) -> usize {
        self.list.iter().map(|yarn| yarn.links.len()).sum()
    }
}

/// Sorts yarns by colours, which are given to the longest yarns first, so that those of one colour are alike in length.
fn coloured(mut yarns: Vec<LaidYarn>, particle_count: usize) -> (Vec<LaidYarn>, Colours) {
    yarns.sort_by_key(|yarn| Reverse(yarn.links.len()));
    let particles = |yarn: &LaidYarn| -> Vec<u32> {
        yarn.nodes.iter().flat_map(|node| node.particles).collect()
    };
    let yarns = yarns.into_iter().map(|yarn| (particles(&yarn), yarn)).collect();
    let (yarns, colours) =
        colour_up_to(YARNS_AT_ONCE, particle_count, yarns, |(particles, _)| particles, |_| 0);
    (yarns.into_iter().map(|(_, yarn)| yarn).collect(), colours)
}

/// A node of a line, with the longest piece of the line since the node before.
struct Stop {
    crossing: Crossing,
    piece: Piece,
}

/// The yarns of a line: more than one if it is a ring, or passes a particle again.
fn yarns_of(line: &Line, mesh: &RestMesh, spacing: &[f32], widths: &Widths) -> Vec<LaidYarn> {
    let stops = thinned(line, spacing);
    let mut yarns = Vec::new();
    let mut from = 0;
    while from + 1 < stops.len() {
        let to = last_within_band(&stops, from);
        yarns.push(yarn(&stops[from..=to], mesh, widths));
        from = to;
    }
    if let (true, [first, .., last]) = (line.is_ring, &stops[..]) {
        let closing = [
            Stop { crossing: last.crossing, piece: last.piece },
            Stop { crossing: first.crossing, piece: last.piece },
        ];
        yarns.push(yarn(&closing, mesh, widths));
    }
    yarns
}

/// The crossings of a line without those that are too near to the one before, and such that no particle moves links
/// that are farther apart than the band.
fn thinned(line: &Line, spacing: &[f32]) -> Vec<Stop> {
    let mut stops: Vec<Stop> = Vec::new();
    // Pieces before the first crossing and after the last belong to no link.
    let mut longest = line.pieces[0];
    stops.push(Stop { crossing: line.crossings[0], piece: longest });
    for (index, (&crossing, &piece)) in line.crossings[1..].iter().zip(&line.pieces).enumerate() {
        if piece.length > longest.length {
            longest = piece;
        }
        let least = LEAST_LINK * spacing[piece.triangle as usize];
        if stops[stops.len() - 1].crossing.at.distance(crossing.at) < least {
            // The end of a line stays, and the crossing before it goes.
            if index + 1 < line.pieces.len() || stops.len() < 2 {
                continue;
            }
            stops.pop();
        }
        stops.push(Stop { crossing, piece: longest });
        longest.length = 0.0;
        drop_middle_of_fan(&mut stops);
    }
    stops
}

/// Leaves out a node where one particle has moved more links in succession than the band holds.
fn drop_middle_of_fan(stops: &mut Vec<Stop>) {
    let Some(newest) = stops.last() else { return };
    for particle in newest.crossing.ends {
        let has = |stop: &Stop| stop.crossing.ends.contains(&particle);
        let of_fan = stops.iter().rev().take_while(|stop| has(stop)).count();
        // A particle that moves n nodes in succession moves n + 1 links.
        if of_fan > BAND {
            stops.remove(stops.len() - 1 - of_fan / 2);
            return;
        }
    }
}

/// The last node up to which no particle moves two links that are farther apart than the band.
fn last_within_band(stops: &[Stop], from: usize) -> usize {
    let mut first_of = HashMap::new();
    for (at, stop) in stops.iter().enumerate().skip(from) {
        for particle in stop.crossing.ends {
            let first = *first_of.entry(particle).or_insert(at);
            if at - first >= BAND {
                return at - 1;
            }
        }
    }
    stops.len() - 1
}

fn yarn(stops: &[Stop], mesh: &RestMesh, widths: &Widths) -> LaidYarn {
    let node = |stop: &Stop| Node {
        particles: stop.crossing.ends,
        parts: [1.0 - stop.crossing.part, stop.crossing.part],
    };
    let nodes: Vec<Node> = stops.iter().map(node).collect();
    let at = |node: &Node| -> Vec3 {
        let [a, b] = mesh.positions_of(node.particles);
        a * node.parts[0] + b * node.parts[1]
    };
    let (mut links, mut couplings) = (Vec::new(), Vec::new());
    for (index, ends) in nodes.windows(2).enumerate() {
        let family = stops[index + 1].piece.family;
        let rest_length = at(&ends[0]).distance(at(&ends[1]));
        let width = 0.5 * (widths.at(&ends[0], family) + widths.at(&ends[1], family));
        let factors = factors(ends);
        let mut count = |back: usize| {
            let before = couplings.len();
            if let Some(other) = index.checked_sub(back) {
                couplings.extend(products(&factors, &self::factors(&nodes[other..other + 2])));
            }
            (couplings.len() - before) as u8
        };
        links.push(LaidLink {
            family,
            rest_length,
            slenderness: rest_length / width,
            couplings: core::array::from_fn(&mut count),
        });
    }
    LaidYarn { nodes, links, couplings }
}

/// How the particles at the ends of a link move the vector from its first node to its second.
fn factors(ends: &[Node]) -> Vec<(u32, f32)> {
    let mut factors: Vec<(u32, f32)> = Vec::new();
    for (node, sign) in [(&ends[0], -1.0), (&ends[1], 1.0)] {
        for (&particle, part) in node.particles.iter().zip(node.parts) {
            match factors.iter_mut().find(|(at, _)| *at == particle) {
                Some((_, factor)) => *factor += sign * part,
                None => factors.push((particle, sign * part)),
            }
        }
    }
    factors
}

/// The particles that two links have in common, with the products of their factors.
fn products(one: &[(u32, f32)], other: &[(u32, f32)]) -> Vec<Coupling> {
    let common = |&(particle, factor): &(u32, f32)| {
        let (_, of_other) = other.iter().find(|(at, _)| *at == particle)?;
        Some(Coupling { particle, factor: factor * of_other })
    };
    one.iter().filter_map(common).collect()
}
