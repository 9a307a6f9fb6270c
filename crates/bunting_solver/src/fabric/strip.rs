//! A grid of two lines of particles: a strip, whose links are solved all at once (`constraints/strip.rs`).

use std::collections::HashMap;

use super::chains::Chains;
use super::grid::Grid;
use super::links::Link;

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

/// The rows of a strip, from one end to the other; none of wider grids, or where diagonals are not links.
pub(super) fn rows(grid: &Grid, links: &[Link], chains: &Chains) -> Vec<StripRow> {
    let length = grid.rows.max(grid.columns);
    if grid.rows.min(grid.columns) != 2 || length == 2 || chains.cells.is_empty() {
        return Vec::new();
    }
    let classes: HashMap<[u32; 2], u32> =
        links.iter().map(|link| (sorted(link.particles), link.class)).collect();
    let of_sweep = chains.sweep_links.iter().map(|link| (link.particles, link.target));
    let targets: HashMap<[u32; 2], u32> = of_sweep
        .chain(chains.diagonals())
        .filter(|(ends, _)| ends[0] != ends[1])
        .map(|(ends, target)| (sorted(ends), target))
        .collect();
    let link = |a: u32, b: u32| {
        let ends = sorted([a, b]);
        Some(StripLink { class: *classes.get(&ends)?, target: *targets.get(&ends)? })
    };
    let pair = |place: u32| {
        [0, 1].map(|line| {
            if grid.columns == 2 { grid.index(line, place) } else { grid.index(place, line) }
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

/// The ends of a link, the lower first.
fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}
