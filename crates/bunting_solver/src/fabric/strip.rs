//! Strips of a narrow grid: its pairs of neighbouring lines of particles. The links of a strip are solved all at once
//! (`constraints/strip.rs`).

use std::collections::HashMap;

use super::chains::Chains;
use super::grid::Grid;
use super::links::Link;
use super::topology::ascending;

/// Most lines of a grid that is solved by strips. Fewer: wider grids sag in their own plane. More: wide grids, which
/// chains hold well enough, take twice as long.
const MOST_LINES: u32 = 5;

/// Least length of a narrow grid, in units of its width. Shorter: small grids that chains hold, as coarse levels are,
/// take twice as long. Longer: grids sag in their own plane.
const LEAST_ASPECT: u32 = 4;

/// A link of a strip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StripLink {
    /// Index into the fabric's link classes.
    pub class: u32,
    /// Index of its target length.
    pub target: u32,
}

/// Two opposite particles of a strip, and the links from them on. A link between two pins is none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StripRow {
    /// A particle of each line.
    pub particles: [u32; 2],
    /// The link between the two.
    pub across: Option<StripLink>,
    /// The links along the two lines to the particles of the next row.
    pub along: [Option<StripLink>; 2],
    /// The diagonals to the next row: from the first line to the second, and back.
    pub diagonals: Option<[StripLink; 2]>,
}

/// The strips of a narrow grid, those that begin at even lines first; none of wider grids, or where diagonals are not
/// links. Strips that begin at even lines share no particles, nor do those at odd lines.
pub(super) fn strips(grid: &Grid, links: &[Link], chains: &Chains) -> Vec<Vec<StripRow>> {
    let (lines, length) = (grid.rows.min(grid.columns), grid.rows.max(grid.columns));
    let is_narrow = lines <= MOST_LINES && length > LEAST_ASPECT * (lines - 1);
    if !is_narrow || chains.cells.is_empty() {
        return Vec::new();
    }
    let link = finder(links, chains);
    let firsts = (0..lines - 1).step_by(2).chain((1..lines - 1).step_by(2));
    let strip = |first| rows(grid, length, first, &link);
    firsts.map(strip).collect()
}

/// The rows of the strip that begins at the line `first`, from one end to the other.
fn rows(
    grid: &Grid,
    length: u32,
    first: u32,
    link: impl Fn(u32, u32) -> Option<StripLink>,
) -> Vec<StripRow> {
    let pair = |place: u32| {
        [first, first + 1].map(|line| {
            if grid.columns < grid.rows { grid.index(line, place) } else { grid.index(place, line) }
        })
    };
    let row = |place: u32| {
        let particles @ [first, second] = pair(place);
        let across = link(first, second);
        if place + 1 == length {
            return StripRow { particles, across, along: [None; 2], diagonals: None };
        }
        let [next_first, next_second] = pair(place + 1);
        let diagonals = link(first, next_second).zip(link(second, next_first));
        StripRow {
            particles,
            across,
            along: [link(first, next_first), link(second, next_second)],
            diagonals: diagonals.map(|(one, other)| [one, other]),
        }
    };
    (0..length).map(row).collect()
}

/// The link between two particles, if there is one.
fn finder(links: &[Link], chains: &Chains) -> impl Fn(u32, u32) -> Option<StripLink> {
    let classes: HashMap<[u32; 2], u32> =
        links.iter().map(|link| (ascending(link.particles), link.class)).collect();
    let of_sweep = chains.sweep_links.iter().map(|link| (link.particles, link.target));
    let targets: HashMap<[u32; 2], u32> = of_sweep
        .chain(chains.diagonals())
        .filter(|(ends, _)| ends[0] != ends[1])
        .map(|(ends, target)| (ascending(ends), target))
        .collect();
    move |a, b| {
        let ends = ascending([a, b]);
        Some(StripLink { class: *classes.get(&ends)?, target: *targets.get(&ends)? })
    }
}
