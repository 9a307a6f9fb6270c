//! Chains: yarns in the order in which they are solved, two at a time.
//!
//! Solving a yarn is a long sequence of divisions, each of which waits for the one before. Yarns of one
//! colour are independent, so that two of them, solved in step and stored interleaved, take hardly longer
//! than one. The shorter chain of a pair is filled up with links from its last particle to itself, which have
//! no direction and exert no force.
//!
//! The constant `C` of a link is an `f32`, the same for all cloths of a batch. In the single-cloth layout it
//! is a pack, and a chain stands for as many neighbouring yarns as there are lanes.

use core::ops::Range;
use std::collections::HashMap;

use glam::Vec3;

use super::colour::Colours;
use super::links::{Link, LinkFamily};
use super::topology::ascending;
use super::yarns::Yarn;

/// Number of chains that are solved in step. With three or four, the state of the elimination no longer fits
/// into the registers, which was slower at every width but one.
pub(crate) const CHAINS_PER_PAIR: usize = 2;

/// A yarn in the form in which it is solved.
#[derive(Clone, Debug)]
pub(crate) struct Chain<C = f32> {
    /// Particles along the chain, one more than links.
    pub particles: Vec<u32>,
    /// Links along the chain.
    pub links: Vec<ChainLink<C>>,
    /// Order in which a Gauss–Seidel sweep visits the links: every second link, the last one of a ring among them, then the others,
    /// each with its class.
    pub sweep_order: Vec<(usize, u32)>,
    /// Whether its ends are at one place.
    pub is_closed: bool,
    /// Number of rows in which some lanes of a closed chain have not begun.
    pub leading: usize,
}

impl<C> Chain<C> {
    /// A chain all of whose links are swept.
    pub fn new(
        particles: Vec<u32>,
        links: Vec<ChainLink<C>>,
        is_closed: bool,
        leading: usize,
    ) -> Self {
        let rows = |first: usize| (first..links.len()).step_by(2);
        // Rings side by side and across the lanes end in one row.
        let is_ring = particles.first() == particles.last();
        let first = if is_ring { (links.len() + 1) % 2 } else { 0 };
        let order = rows(first).chain(rows(1 - first));
        let sweep_order = order.map(|at| (at, links[at].class)).collect();
        Self { particles, links, sweep_order, is_closed, leading }
    }
}

/// A link of a chain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ChainLink<C = f32> {
    /// Index into the fabric's link classes.
    pub class: u32,
    /// Distance at rest, m.
    pub rest_length: C,
}

/// Two chains of one colour, interleaved: row i holds the i-th particles, or links, of both. The last pair of
/// a colour may be a single chain.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ChainPair<C = f32> {
    /// Number of chains, one or two. Columns from this number on repeat the last chain and are not solved.
    pub count: usize,
    /// Rows of particles, one more than rows of links.
    pub particles: Vec<[u32; CHAINS_PER_PAIR]>,
    /// Rows of links.
    pub links: Vec<[ChainLink<C>; CHAINS_PER_PAIR]>,
    /// Indices of the links' target lengths: row by row, `count` in each.
    pub targets: Range<usize>,
    /// Whether the ends of each chain are at one place.
    pub is_closed: bool,
    /// Number of rows in which some lanes of the closed chains have not begun.
    pub leading: usize,
}

/// The chains of one colour.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ChainColour {
    /// Direction of the chains' links.
    pub family: LinkFamily,
    /// Indices of the colour's pairs in [`Chains::pairs`].
    pub pairs: Range<usize>,
    /// Indices of the colour's links in [`Chains::sweep_links`].
    pub sweep_links: Range<usize>,
}

impl ChainColour {
    /// Whether these are diagonals that a sweep over them solves.
    pub fn are_swept_diagonals(&self) -> bool {
        self.family == LinkFamily::Diagonal && !self.sweep_links.is_empty()
    }
}

/// A link of a Gauss–Seidel sweep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SweepLink {
    /// The two particles.
    pub particles: [u32; 2],
    /// Index into the fabric's link classes.
    pub class: u32,
    /// Index of the link's target length.
    pub target: u32,
}

/// A cell of a grid, or a pack of cells, with its diagonals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cell {
    /// The first diagonal joins the first and the last corner, the second one the other two.
    pub corners: [u32; 4],
    /// Indices of the diagonals' target lengths; twice that of the first if the second one is no link, or is listed
    /// with another pack.
    pub targets: [u32; 2],
}

/// All chains of a fabric.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Chains<C = f32> {
    /// Pairs of chains, colour by colour.
    pub pairs: Vec<ChainPair<C>>,
    /// Colours in the order in which they are solved: warp, weft, diagonals.
    pub colours: Vec<ChainColour>,
    /// Links of warp and weft, chain after chain; neighbours in the list share no particle. Those of diagonals, too, if a sweep solves
    /// them.
    pub sweep_links: Vec<SweepLink>,
    /// The cells of a grid whose diagonals are links; none for other meshes.
    pub cells: Vec<Cell>,
    /// Lengths at rest of the two diagonals of each cell, m; empty where all are alike.
    pub diagonal_lengths: Vec<[C; 2]>,
}

impl Chains {
    /// Chains of all yarns.
    pub(super) fn of(yarns: &[Yarn], colours: &Colours, links: &[Link]) -> Self {
        let chain = |yarn: &Yarn| {
            let of_chain = yarn.links.iter().map(|link| ChainLink::of(&links[*link as usize]));
            Chain::new(yarn.particles.clone(), of_chain.collect(), yarn.is_ring(), 0)
        };
        Self::of_colours(colours.ranges().iter().map(|range| {
            let yarns = &yarns[range.clone()];
            let family = links[yarns[0].links[0] as usize].family;
            (family, yarns.iter().map(chain).collect())
        }))
    }

    /// Notes the lengths at rest of each cell's diagonals, given the positions of the particles, m.
    pub(super) fn measure_diagonals(&mut self, rest: &[Vec3]) {
        let length = |one: u32, other: u32| rest[one as usize].distance(rest[other as usize]);
        let of_cell = |cell: &Cell| {
            let [first, left, right, last] = cell.corners;
            [length(first, last), length(left, right)]
        };
        self.diagonal_lengths = self.cells.iter().map(of_cell).collect();
    }

    /// Notes the cells with these corners, with the targets of the diagonals that are links.
    pub(super) fn find_cells(&mut self, corners: impl Iterator<Item = [u32; 4]>) {
        let targets: HashMap<[u32; 2], u32> =
            self.diagonals().map(|(ends, target)| (ascending(ends), target)).collect();
        let cell = |[top_left, top_right, bottom_left, bottom_right]: [u32; 4]| {
            let target = |one: u32, other: u32| targets.get(&ascending([one, other]));
            let falling = target(top_left, bottom_right);
            let rising = target(top_right, bottom_left);
            let corners = [top_left, top_right, bottom_left, bottom_right];
            let mirrored = [top_right, top_left, bottom_right, bottom_left];
            match (falling, rising) {
                (Some(&falling), rising) => {
                    Some(Cell { corners, targets: [falling, *rising.unwrap_or(&falling)] })
                }
                (None, Some(&rising)) => Some(Cell { corners: mirrored, targets: [rising; 2] }),
                (None, None) => None,
            }
        };
        self.cells = corners.filter_map(cell).collect();
    }
}

impl<C: Copy> Chains<C> {
    /// Arranges chains, given colour by colour, in pairs. There are no cells.
    pub fn of_colours(colours: impl Iterator<Item = (LinkFamily, Vec<Chain<C>>)>) -> Self {
        let mut chains = Self {
            pairs: Vec::new(),
            colours: Vec::new(),
            sweep_links: Vec::new(),
            cells: Vec::new(),
            diagonal_lengths: Vec::new(),
        };
        for (family, of_colour) in colours {
            let (first_pair, first_link) = (chains.pairs.len(), chains.sweep_links.len());
            // Closed chains of different lengths end in different rows.
            let alike = |one: &Chain<C>, other: &Chain<C>| {
                one.is_closed == other.is_closed
                    && (!one.is_closed || one.links.len() == other.links.len())
            };
            for run in of_colour.chunk_by(alike) {
                run.chunks(CHAINS_PER_PAIR).for_each(|pair| chains.push_pair(family, pair));
            }
            chains.colours.push(ChainColour {
                family,
                pairs: first_pair..chains.pairs.len(),
                sweep_links: first_link..chains.sweep_links.len(),
            });
        }
        chains
    }

    fn push_pair(&mut self, family: LinkFamily, chains: &[Chain<C>]) {
        let first_target = self.target_count();
        self.pairs.push(ChainPair::of(chains, first_target));
        if family == LinkFamily::Diagonal {
            return;
        }
        for (column, chain) in chains.iter().enumerate() {
            self.sweep_links.extend(chain.sweep_order.iter().map(|&(row, class)| SweepLink {
                particles: [chain.particles[row], chain.particles[row + 1]],
                class,
                target: (first_target + row * chains.len() + column) as u32,
            }));
        }
    }

    /// Lists diagonals for a sweep, which solves them in place of chains, where each of them is a chain by itself.
    pub fn sweep_diagonals(&mut self) {
        for colour in &mut self.colours {
            if colour.family != LinkFamily::Diagonal {
                continue;
            }
            let first = self.sweep_links.len();
            for pair in &self.pairs[colour.pairs.clone()] {
                self.sweep_links.extend((0..pair.count).map(|column| SweepLink {
                    particles: [0, 1].map(|end| pair.particles[end][column]),
                    class: pair.links[0][column].class,
                    target: (pair.targets.start + column) as u32,
                }));
            }
            colour.sweep_links = first..self.sweep_links.len();
        }
    }

    /// The diagonal links, including those that fill up a shorter chain: both ends, and the index of the
    /// target length.
    pub fn diagonals(&self) -> impl Iterator<Item = ([u32; 2], u32)> {
        let diagonal = self.colours.iter().filter(|colour| colour.family == LinkFamily::Diagonal);
        diagonal.flat_map(|colour| &self.pairs[colour.pairs.clone()]).flat_map(|pair| {
            let rows = pair.particles.windows(2).enumerate();
            rows.flat_map(move |(row, ends)| {
                (0..pair.count).map(move |column| {
                    let target = pair.targets.start + row * pair.count + column;
                    ([ends[0][column], ends[1][column]], target as u32)
                })
            })
        })
    }

    /// Number of target lengths, including those of links that fill up a shorter chain.
    pub fn target_count(&self) -> usize {
        self.pairs.last().map_or(0, |pair| pair.targets.end)
    }

    /// Greatest number of rows of links in a pair of closed chains.
    pub fn longest_closed(&self) -> usize {
        let closed = self.pairs.iter().filter(|pair| pair.is_closed);
        closed.map(|pair| pair.links.len()).max().unwrap_or(0)
    }

    /// Greatest number of rows of links in a pair.
    pub fn longest(&self) -> usize {
        self.pairs.iter().map(|pair| pair.links.len()).max().unwrap_or(0)
    }
}

impl Chains {
    /// The class of each link, after the index of its target length.
    pub fn classes(&self) -> impl Iterator<Item = (u32, u32)> {
        self.pairs.iter().flat_map(|pair| {
            let links = pair.links.iter().flat_map(|row| &row[..pair.count]);
            (pair.targets.start as u32..).zip(links.map(|link| link.class))
        })
    }

    /// A copy in which each link is a class of its own, whose index is that of the link's target length.
    pub fn with_a_class_for_each_link<C: Copy>(&self, constant: fn(f32) -> C) -> Chains<C> {
        let pair = |pair: &ChainPair| {
            let rows = pair.links.iter().enumerate();
            let links = rows.map(|(row, links)| {
                core::array::from_fn(|column| ChainLink {
                    class: (pair.targets.start + row * pair.count + column.min(pair.count - 1))
                        as u32,
                    rest_length: constant(links[column].rest_length),
                })
            });
            ChainPair {
                count: pair.count,
                particles: pair.particles.clone(),
                links: links.collect(),
                targets: pair.targets.clone(),
                is_closed: pair.is_closed,
                leading: pair.leading,
            }
        };
        let sweep_link = |link: &SweepLink| SweepLink { class: link.target, ..*link };
        Chains {
            pairs: self.pairs.iter().map(pair).collect(),
            colours: self.colours.clone(),
            sweep_links: self.sweep_links.iter().map(sweep_link).collect(),
            cells: self.cells.clone(),
            diagonal_lengths: self.diagonal_lengths.iter().map(|of| of.map(&constant)).collect(),
        }
    }
}

impl ChainLink {
    fn of(link: &Link) -> Self {
        Self { class: link.class, rest_length: link.rest_length }
    }
}

impl<C: Copy> ChainPair<C> {
    /// One or two chains, with targets from an index on.
    fn of(chains: &[Chain<C>], first_target: usize) -> Self {
        let rows = chains.iter().map(|chain| chain.links.len()).max().unwrap_or(0);
        let chain = |column: usize| &chains[column.min(chains.len() - 1)];
        let particles = (0..=rows).map(|row| {
            core::array::from_fn(|column| {
                let path = &chain(column).particles;
                path[row.min(path.len() - 1)]
            })
        });
        let links = (0..rows).map(|row| {
            core::array::from_fn(|column| {
                let path = &chain(column).links;
                path[row.min(path.len() - 1)]
            })
        });
        Self {
            count: chains.len(),
            particles: particles.collect(),
            links: links.collect(),
            targets: first_target..first_target + rows * chains.len(),
            is_closed: chains.iter().all(|chain| chain.is_closed),
            leading: chains.iter().map(|chain| chain.leading).max().unwrap_or(0),
        }
    }
}
