//! Chains of a single cloth, in packs of neighbouring yarns.
//!
//! A pack of chains has one yarn in each lane. Its links lie between consecutive lines of the arrays. If the
//! yarns are diagonals, each line begins one particle further on than the line before.

use core::ops::Range;
use std::collections::{BTreeMap, HashMap};

use glam::Vec3;

use super::grid_shape::GridShape;
use super::lane_indices::{LaneIndices, MOST_LANES, NO_INDEX};
use crate::batch::layout::Order;
use crate::fabric::{Cell, Chain, ChainLink, Chains, Fabric, Grid, Link, LinkFamily, Yarn};
use crate::simd::constant::Constant;
use crate::simd::lane::Pack;

/// A link in a lane.
#[derive(Clone, Copy, Debug)]
struct LaneLink {
    /// The fabric's class; [`NO_INDEX`] if there is no link.
    class: u32,
    /// Length at rest, m.
    rest_length: f32,
    /// Whether the link's index along its yarn is odd.
    is_odd: bool,
}

impl LaneLink {
    const NONE: Self = Self { class: NO_INDEX, rest_length: 0.0, is_odd: false };

    fn exists(&self) -> bool {
        self.class != NO_INDEX
    }
}

/// Links of yarns in one direction: by the line of the arrays on which the link begins, and by the yarn.
struct Links {
    /// Number of the first yarn that the table has room for.
    first: isize,
    /// Line after line, one of each yarn.
    table: Vec<LaneLink>,
    /// Number of yarns that the table has room for.
    room: usize,
    /// The yarns that have links, counted from the first one of the table.
    yarns: Range<usize>,
}

impl Links {
    /// No links yet, with room for all yarns of a direction.
    fn new(grid: &Grid, direction: Direction) -> Self {
        let (columns, rows) = (grid.columns as usize, grid.rows as usize);
        let (lines, across) = match direction.order() {
            Order::ColumnMajor => (columns, rows),
            Order::RowMajor => (rows, columns),
        };
        // Skewed yarns are counted by the place at which they would cross the first line.
        let beyond = (lines - 1) * direction.skew().unsigned_abs();
        let room = across + beyond;
        let first = if direction.skew() > 0 { -(beyond as isize) } else { 0 };
        Self { first, table: vec![LaneLink::NONE; lines * room], room, yarns: room..0 }
    }

    /// Adds a link that begins on a line.
    fn push(&mut self, line: usize, yarn: isize, link: LaneLink) {
        let yarn = (yarn - self.first) as usize;
        self.table[line * self.room + yarn] = link;
        self.yarns = self.yarns.start.min(yarn)..self.yarns.end.max(yarn + 1);
    }

    /// Links of consecutive yarns that begin on a line.
    fn on_line(&self, line: usize, yarns: Range<usize>) -> &[LaneLink] {
        &self.table[line * self.room..][yarns]
    }

    /// Number of lines.
    fn lines(&self) -> usize {
        self.table.len() / self.room
    }
}

/// Direction of a yarn: columns and rows from each particle to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Direction {
    columns: isize,
    rows: isize,
}

impl Direction {
    /// The direction of a straight yarn; none if the yarn bends, or runs in a direction other than a row, a
    /// column or a diagonal.
    fn of(grid: &Grid, yarn: &Yarn) -> Option<Self> {
        let place = |particle: u32| {
            ((particle % grid.columns) as isize, (particle / grid.columns) as isize)
        };
        let mut steps = yarn.particles.windows(2).map(|ends| {
            let ((c0, r0), (c1, r1)) = (place(ends[0]), place(ends[1]));
            Self { columns: c1 - c0, rows: r1 - r0 }
        });
        let direction = steps.next()?;
        let fits = matches!((direction.columns, direction.rows), (1, 0) | (-1..=1, 1));
        (fits && steps.all(|step| step == direction)).then_some(direction)
    }

    /// The order in which neighbouring yarns are consecutive.
    fn order(self) -> Order {
        if self.rows == 0 { Order::ColumnMajor } else { Order::RowMajor }
    }

    /// Number of particles by which each line begins further on than the line before.
    fn skew(self) -> isize {
        if self.rows == 0 { 0 } else { self.columns }
    }

    /// The line of the arrays on which a particle lies, and the number of its yarn.
    fn line_and_yarn(self, grid: &Grid, particle: u32) -> (usize, isize) {
        let (column, row) = (particle % grid.columns, particle / grid.columns);
        match self.order() {
            Order::ColumnMajor => (column as usize, row as isize),
            Order::RowMajor => (row as usize, column as isize - self.skew() * row as isize),
        }
    }
}

/// Packs of chains.
#[derive(Clone, Debug)]
pub(super) struct ChainPacks<P: Pack> {
    /// The `class` of a link is an index into `classes`.
    pub chains: Chains<P>,
    /// For each colour, the order in which its yarns are consecutive.
    pub orders: Vec<Order>,
    /// For each class of links of packs, the fabric's class in each lane.
    pub classes: Vec<LaneIndices>,
}

impl<P: Pack> ChainPacks<P> {
    /// The chains of a grid; none if its yarns do not run straight.
    pub fn new(fabric: &Fabric, shape: GridShape) -> Option<Self> {
        let grid = fabric.grid()?;
        let mut packer = Packer { shape, classes: Vec::new(), known: HashMap::new() };
        let mut colours: Vec<(LinkFamily, Vec<Chain<P>>)> = Vec::new();
        let mut orders = Vec::new();
        for range in fabric.yarn_colours().ranges() {
            let yarns = &fabric.yarns()[range.clone()];
            let family = fabric.links()[yarns[0].links[0] as usize].family;
            let directions = by_direction(fabric, grid, yarns)?;
            // Both diagonals have one order.
            orders.push(directions.keys().next()?.order());
            let packs = directions.iter().flat_map(|(to, links)| packer.pack(*to, links));
            colours.push((family, packs.collect()));
        }
        let mut chains = Chains::of_colours(colours.into_iter());
        chains.cells = cells(&chains, shape);
        if !fabric.chains().diagonal_lengths.is_empty() {
            chains.diagonal_lengths =
                diagonal_lengths(&chains.cells, shape, fabric.rest_positions());
        }
        Some(Self { chains, orders, classes: packer.classes })
    }
}

/// The links of yarns of one colour, by direction; diagonals that cross between particles may share a colour.
/// None if a yarn does not run straight.
fn by_direction(
    fabric: &Fabric,
    grid: &Grid,
    yarns: &[Yarn],
) -> Option<BTreeMap<Direction, Links>> {
    let mut directions = BTreeMap::new();
    for yarn in yarns {
        let direction = Direction::of(grid, yarn)?;
        let links = directions.entry(direction).or_insert_with(|| Links::new(grid, direction));
        for (index, (&particle, &link)) in yarn.particles.iter().zip(&yarn.links).enumerate() {
            let (line, yarn) = direction.line_and_yarn(grid, particle);
            let Link { class, rest_length, .. } = fabric.links()[link as usize];
            links.push(line, yarn, LaneLink { class, rest_length, is_odd: index % 2 == 1 });
        }
    }
    Some(directions)
}

/// The cells whose diagonals are links, one for each link of a pack of diagonals.
fn cells<P: Pack>(chains: &Chains<P>, shape: GridShape) -> Vec<Cell> {
    let stride = shape.row_stride as u32;
    let of_diagonal = |([above, below], target): ([u32; 2], u32)| {
        let others =
            if below > above + stride { [above + 1, below - 1] } else { [above - 1, below + 1] };
        Cell { corners: [above, others[0], others[1], below], targets: [target; 2] }
    };
    chains.diagonals().map(of_diagonal).collect()
}

/// Lengths at rest of the two diagonals of each cell, m; one in lanes without a cell, or without cloth in it.
fn diagonal_lengths<P: Pack>(cells: &[Cell], shape: GridShape, rest: &[Vec3]) -> Vec<[P; 2]> {
    let length = |ends: [u32; 2]| {
        P::of(|lane| match ends.map(|end| shape.particle(end + lane as u32)) {
            [Some(one), Some(other)] if rest[one] != rest[other] => rest[one].distance(rest[other]),
            _ => 1.0,
        })
    };
    let of_cell = |cell: &Cell| {
        let [first, left, right, last] = cell.corners;
        [[first, last], [left, right]].map(length)
    };
    cells.iter().map(of_cell).collect()
}

/// Packs neighbouring yarns.
struct Packer {
    shape: GridShape,
    classes: Vec<LaneIndices>,
    /// The class with these classes of the fabric in its lanes.
    known: HashMap<LaneIndices, u32>,
}

impl Packer {
    /// Packs the yarns of one direction, the longest first.
    fn pack<P: Pack>(&mut self, direction: Direction, links: &Links) -> Vec<Chain<P>> {
        let yarns = links.yarns.clone().step_by(P::WIDTH);
        let of_pack = |first: usize| first..(first + P::WIDTH).min(links.yarns.end);
        let mut chains: Vec<Chain<P>> =
            yarns.filter_map(|first| self.chain(direction, of_pack(first), links)).collect();
        chains.sort_by_key(|chain| core::cmp::Reverse(chain.links.len()));
        chains
    }

    /// Packs neighbouring yarns, at most one for each lane; none if there are no links.
    fn chain<P: Pack>(
        &mut self,
        direction: Direction,
        yarns: Range<usize>,
        links: &Links,
    ) -> Option<Chain<P>> {
        let on_line = |line| links.on_line(line, yarns.clone());
        let is_linked = |&line: &usize| on_line(line).iter().any(LaneLink::exists);
        let begin = (0..links.lines()).find(is_linked)?;
        let end = (0..links.lines()).rfind(is_linked)? + 1;
        let mut chain_links = Vec::with_capacity(end - begin);
        let mut sweep = [Vec::new(), Vec::new()];
        for line in begin..end {
            let mut lanes = [LaneLink::NONE; MOST_LANES];
            lanes[..yarns.len()].copy_from_slice(on_line(line));
            chain_links.push(ChainLink {
                class: self.class(lanes.map(|link| link.class)),
                rest_length: P::of(|lane| lanes[lane].rest_length),
            });
            // Even and odd links are counted from the beginning of each yarn, which pins may shift.
            for (is_odd, sweep) in [false, true].into_iter().zip(&mut sweep) {
                let of_parity =
                    lanes.map(|link| if link.is_odd == is_odd { link.class } else { NO_INDEX });
                if of_parity != [NO_INDEX; MOST_LANES] {
                    sweep.push((line - begin, self.class(of_parity)));
                }
            }
        }
        let first = links.first + yarns.start as isize;
        let skewed = |line| first + direction.skew() * line as isize;
        let at = |line| self.shape.index(direction.order(), line, skewed(line));
        Some(Chain {
            particles: (begin..=end).map(at).collect(),
            links: chain_links,
            sweep_order: sweep.concat(),
            is_closed: false,
            leading: 0,
        })
    }

    /// The class of links with these classes of the fabric in their lanes.
    fn class(&mut self, of_lanes: LaneIndices) -> u32 {
        *self.known.entry(of_lanes).or_insert_with(|| {
            self.classes.push(of_lanes);
            self.classes.len() as u32 - 1
        })
    }
}
