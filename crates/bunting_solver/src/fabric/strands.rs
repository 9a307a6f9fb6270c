//! Yarns laid out for the order in which they are solved: two abreast.
//!
//! Solving a yarn is one long chain of divisions, each waiting on the last; yarns of one colour do
//! not wait on one another. So they are solved side by side, and stored interleaved. A shorter yarn
//! is drawn out to the length of its neighbours by links from its last particle to itself, which
//! have no direction and pull nothing.

use core::ops::Range;
use std::collections::HashMap;

use super::colour::Colours;
use super::links::{Link, LinkFamily};
use super::yarns::Yarn;

/// How many yarns lie side by side. Three or four no longer fit into the registers, and were slower
/// at every width but one.
pub(crate) const ABREAST: usize = 2;

/// Yarns of one colour side by side.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Strand<C = f32> {
    /// How many yarns there are; in rows, the columns from here on mean nothing.
    pub count: usize,
    /// Rows of particles, one more than there are rows of links.
    pub particles: Vec<[u32; ABREAST]>,
    /// Rows of links.
    pub links: Vec<[StrandLink<C>; ABREAST]>,
    /// Where among all targets those of its links are: row by row, `count` a row.
    pub targets: Range<usize>,
}

/// A link as it is solved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StrandLink<C = f32> {
    /// Index into the fabric's link classes.
    pub class: u32,
    /// Distance at rest, m.
    pub rest_length: C,
}

/// A yarn as it is solved.
#[derive(Clone, Debug)]
pub(crate) struct Thread<C = f32> {
    /// Particles along it, one more than there are links.
    pub particles: Vec<u32>,
    pub links: Vec<StrandLink<C>>,
    /// Which links are polished, one after the other, and the class of each: every second link and then
    /// the others.
    pub polish: Vec<(usize, u32)>,
}

/// Strands of one colour.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct StrandColour {
    pub family: LinkFamily,
    pub strands: Range<usize>,
    pub polish: Range<usize>,
}

/// All yarns of a fabric, laid side by side.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Strands<C = f32> {
    /// Colour by colour.
    pub strands: Vec<Strand<C>>,
    pub colours: Vec<StrandColour>,
    /// Warp and weft link by link, yarn after yarn: in each, every second link and then the others,
    /// so that neighbours in the list share no particle.
    pub polish: Vec<PolishLink>,
    /// The cells of a grid whose diagonals are links; none of other meshes.
    pub cells: Vec<Cell>,
}

/// A cell of a grid, or a pack of them, and its diagonals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cell {
    /// Top left, top right, bottom left and bottom right.
    pub corners: [u32; 4],
    /// Indices of the targets of its diagonals; twice the same where there is but one.
    pub targets: [u32; 2],
}

/// A link as it is polished.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PolishLink {
    /// The two particles.
    pub particles: [u32; 2],
    /// Index into the fabric's link classes.
    pub class: u32,
    /// Index of its target.
    pub target: u32,
}

impl Strands {
    /// Lays yarns side by side, colour by colour.
    pub fn new(yarns: &[Yarn], colours: &Colours, links: &[Link]) -> Self {
        let as_solved = |yarn: &Yarn| {
            let count = yarn.links.len();
            let order = (0..count).step_by(2).chain((1..count).step_by(2));
            let link = |at: usize| &links[yarn.links[at] as usize];
            Thread {
                particles: yarn.particles.clone(),
                links: (0..count).map(|at| StrandLink::of(link(at))).collect(),
                polish: order.map(|at| (at, link(at).class)).collect(),
            }
        };
        Self::of(colours.ranges().iter().map(|range| {
            let yarns = &yarns[range.clone()];
            let family = links[yarns[0].links[0] as usize].family;
            (family, yarns.iter().map(as_solved).collect())
        }))
    }
}

impl<C: Copy> Strands<C> {
    /// Lays what is solved alike side by side, colour by colour.
    pub fn of(colours: impl Iterator<Item = (LinkFamily, Vec<Thread<C>>)>) -> Self {
        let mut strands: Vec<Strand<C>> = Vec::new();
        let mut coloured = Vec::new();
        let mut polish = Vec::new();
        for (family, threads) in colours {
            let (first_strand, first_link) = (strands.len(), polish.len());
            for side in threads.chunks(ABREAST) {
                let targets = strands.last().map_or(0, |strand| strand.targets.end);
                strands.push(Strand::new(side, targets));
                if family == LinkFamily::Bias {
                    continue;
                }
                for (at, thread) in side.iter().enumerate() {
                    polish.extend(thread.polish.iter().map(|&(row, class)| PolishLink {
                        particles: [thread.particles[row], thread.particles[row + 1]],
                        class,
                        target: (targets + row * side.len() + at) as u32,
                    }));
                }
            }
            let (strands, polish) = (first_strand..strands.len(), first_link..polish.len());
            coloured.push(StrandColour { family, strands, polish });
        }
        Self { strands, colours: coloured, polish, cells: Vec::new() }
    }

    /// The bias links, column by column of their strands: both ends, and the index of the target.
    pub fn bias(&self) -> impl Iterator<Item = ([u32; 2], u32)> {
        let bias = self.colours.iter().filter(|colour| colour.family == LinkFamily::Bias);
        bias.flat_map(|colour| &self.strands[colour.strands.clone()]).flat_map(|strand| {
            let rows = strand.particles.windows(2).enumerate();
            rows.flat_map(move |(row, ends)| {
                (0..strand.count).map(move |at| {
                    let target = strand.targets.start + row * strand.count + at;
                    ([ends[0][at], ends[1][at]], target as u32)
                })
            })
        })
    }

    /// Number of targets, those of links that only fill included.
    pub fn target_count(&self) -> usize {
        self.strands.last().map_or(0, |strand| strand.targets.end)
    }

    /// Most links that one strand has.
    pub fn longest(&self) -> usize {
        self.strands.iter().map(|strand| strand.links.len()).max().unwrap_or(0)
    }
}

impl Strands {
    /// Finds the diagonals of cells, given their corners.
    pub fn set_cells(&mut self, cells: impl Iterator<Item = [u32; 4]>) {
        let targets: HashMap<[u32; 2], u32> =
            self.bias().map(|([a, b], target)| ([a.min(b), a.max(b)], target)).collect();
        let cells = cells.filter_map(|corners| {
            let [top_left, top_right, bottom_left, bottom_right] = corners;
            let falling = targets.get(&[top_left, bottom_right]);
            let rising = targets.get(&[top_right, bottom_left]);
            let targets = [*falling.or(rising)?, *rising.or(falling)?];
            Some(Cell { corners, targets })
        });
        self.cells = cells.collect();
    }
}

impl StrandLink {
    fn of(link: &Link) -> Self {
        Self { class: link.class, rest_length: link.rest_length }
    }
}

impl<C: Copy> Strand<C> {
    fn new(threads: &[Thread<C>], first_target: usize) -> Self {
        let rows = threads.iter().map(|thread| thread.links.len()).max().unwrap_or(0);
        let column = |at: usize| &threads[at.min(threads.len() - 1)];
        let particles = (0..=rows).map(|row| {
            core::array::from_fn(|at| {
                let path = &column(at).particles;
                path[row.min(path.len() - 1)]
            })
        });
        let links = (0..rows).map(|row| {
            core::array::from_fn(|at| {
                let path = &column(at).links;
                path[row.min(path.len() - 1)]
            })
        });
        Self {
            count: threads.len(),
            particles: particles.collect(),
            links: links.collect(),
            targets: first_target..first_target + rows * threads.len(),
        }
    }
}
