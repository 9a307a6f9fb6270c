//! The yarns of a grid, side by side in the lanes.

use std::collections::{BTreeMap, HashMap};

use super::{Facing, OfLanes, Sheets};
use crate::batch::places::Constant;
use crate::fabric::{Cell, Chain, ChainLink, Chains, Fabric, Grid, Link, LinkFamily, Yarn};
use crate::simd::lane::Pack;

/// The links of yarns of one course, each by the line of the sheet on which it begins and by its yarn,
/// and where on its yarn it is.
type Links<'a> = HashMap<(usize, isize), (&'a Link, usize)>;

/// Where a yarn runs: how many columns and rows from each particle to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Course {
    columns: isize,
    rows: isize,
}

impl Course {
    /// That of a yarn, if it has one, and one that fits into lanes.
    fn of(grid: &Grid, yarn: &Yarn) -> Option<Self> {
        let place = |particle: u32| {
            ((particle % grid.columns) as isize, (particle / grid.columns) as isize)
        };
        let mut steps = yarn.particles.windows(2).map(|ends| {
            let ((c0, r0), (c1, r1)) = (place(ends[0]), place(ends[1]));
            Self { columns: c1 - c0, rows: r1 - r0 }
        });
        let course = steps.next()?;
        let fits = matches!((course.columns, course.rows), (1, 0) | (-1..=1, 1));
        (fits && steps.all(|step| step == course)).then_some(course)
    }

    fn facing(self) -> Facing {
        if self.rows == 0 { Facing::Turned } else { Facing::Straight }
    }

    /// How much further on each line of the sheet begins.
    fn skew(self) -> isize {
        if self.rows == 0 { 0 } else { self.columns }
    }

    /// On which line of the sheet a particle lies, and which yarn's it is.
    fn line_and_yarn(self, grid: &Grid, particle: u32) -> (usize, isize) {
        let (column, row) = (particle % grid.columns, particle / grid.columns);
        match self.facing() {
            Facing::Turned => (column as usize, row as isize),
            Facing::Straight => (row as usize, column as isize - self.skew() * row as isize),
        }
    }
}

/// All yarns, along what those of each colour lie, and the classes of their links. None where they do
/// not run straight.
pub(super) fn strands<P: Pack>(
    fabric: &Fabric,
    sheets: &Sheets,
) -> Option<(Chains<P>, Vec<Facing>, Vec<OfLanes>)> {
    let grid = fabric.grid()?;
    let mut classes = Vec::new();
    let mut colours: Vec<(LinkFamily, Vec<Chain<P>>)> = Vec::new();
    let mut facings = Vec::new();
    for range in fabric.yarn_colours().ranges() {
        let yarns = &fabric.yarns()[range.clone()];
        let family = fabric.links()[yarns[0].links[0] as usize].family;
        // Diagonals that cross between particles may be of one colour.
        let mut courses: BTreeMap<Course, Links> = BTreeMap::new();
        for yarn in yarns {
            let course = Course::of(grid, yarn)?;
            let links = courses.entry(course).or_default();
            for (index, (&particle, &link)) in yarn.particles.iter().zip(&yarn.links).enumerate() {
                let at = course.line_and_yarn(grid, particle);
                links.insert(at, (&fabric.links()[link as usize], index));
            }
        }
        for (course, links) in courses {
            let first = links.keys().map(|&(_, yarn)| yarn).min()?;
            let last = links.keys().map(|&(_, yarn)| yarn).max()?;
            let blocks = (first..=last).step_by(P::WIDTH);
            let mut threads: Vec<Chain<P>> = blocks
                .filter_map(|first| thread(course, first, &links, sheets, &mut classes))
                .collect();
            threads.sort_by_key(|thread| core::cmp::Reverse(thread.links.len()));
            colours.push((family, threads));
            facings.push(course.facing());
        }
    }
    let mut strands = Chains::of_colours(colours.into_iter());
    // Packs of diagonals, each with those that cross them.
    let stride = sheets.stride() as u32;
    let cells = strands.diagonals().map(|([above, below], target)| {
        let left = if below > above + stride { above } else { above - 1 };
        Cell { corners: [left, left + 1, left + stride, left + stride + 1], targets: [target; 2] }
    });
    strands.cells = cells.collect();
    Some((strands, facings, classes))
}

/// Yarns side by side, from the first on.
fn thread<P: Pack>(
    course: Course,
    first: isize,
    links: &Links,
    sheets: &Sheets,
    classes: &mut Vec<OfLanes>,
) -> Option<Chain<P>> {
    let here = first..first + P::WIDTH as isize;
    let lines = || links.keys().filter(|(_, yarn)| here.contains(yarn)).map(|&(line, _)| line);
    let (begin, end) = (lines().min()?, lines().max()? + 1);
    let at = |line| sheets.at(course.facing(), line, first + course.skew() * line as isize);
    let lanes = |line| -> Vec<Option<(&Link, usize)>> {
        (first..).take(P::WIDTH).map(|yarn| links.get(&(line, yarn)).copied()).collect()
    };
    let mut class = |of_lanes: OfLanes| {
        let known = classes.iter().position(|known| *known == of_lanes);
        known.unwrap_or_else(|| {
            classes.push(of_lanes);
            classes.len() - 1
        }) as u32
    };
    let mut strand_links = Vec::new();
    let mut polish = [Vec::new(), Vec::new()];
    for line in begin..end {
        let lanes = lanes(line);
        let of_link = |(link, _): (&Link, usize)| link.class;
        strand_links.push(ChainLink {
            class: class(lanes.iter().map(|link| link.map(of_link)).collect()),
            rest_length: P::of(|lane| lanes[lane].map_or(0.0, |(link, _)| link.rest_length)),
        });
        // A yarn that begins at a pin further on counts its links from there.
        for (parity, polish) in polish.iter_mut().enumerate() {
            let alike = lanes.iter().map(|link| link.filter(|(_, index)| index % 2 == parity));
            let of_lanes: OfLanes = alike.map(|link| link.map(of_link)).collect();
            if of_lanes.iter().any(Option::is_some) {
                polish.push((line - begin, class(of_lanes)));
            }
        }
    }
    Some(Chain {
        particles: (begin..=end).map(at).collect(),
        links: strand_links,
        sweep_order: polish.concat(),
    })
}
