//! Chains of a single cloth, in packs of neighbouring yarns.
//!
//! A pack of chains has one yarn in each lane. Its links lie between consecutive lines of the arrays. If the
//! yarns are diagonals, each line begins one particle further on than the line before.

use core::array;
use std::collections::BTreeMap;

use super::grid_shape::GridShape;
use super::{LaneIndices, MOST_LANES};
use crate::batch::layout::Order;
use crate::fabric::{Cell, Chain, ChainLink, Chains, Fabric, Grid, Link, LinkFamily, Yarn};
use crate::simd::constant::Constant;
use crate::simd::lane::Pack;

/// A link, and its index along its yarn.
type OnYarn<'a> = (&'a Link, usize);

/// Links of yarns in one direction: by the line of the arrays on which the link begins, and by the yarn.
struct Links<'a> {
    /// Number of the first yarn.
    first: isize,
    /// Line after line, one of each yarn.
    table: Vec<Option<OnYarn<'a>>>,
    /// Number of yarns.
    yarns: usize,
}

impl<'a> Links<'a> {
    /// Links with their lines and yarns; none where there are no links.
    fn of(links: &[((usize, isize), OnYarn<'a>)]) -> Option<Self> {
        let numbers = || links.iter().map(|&((_, yarn), _)| yarn);
        let (first, last) = (numbers().min()?, numbers().max()?);
        let lines = links.iter().map(|&((line, _), _)| line).max()? + 1;
        let yarns = (last - first) as usize + 1;
        let mut table = vec![None; lines * yarns];
        for &((line, yarn), link) in links {
            table[line * yarns + (yarn - first) as usize] = Some(link);
        }
        Some(Self { first, table, yarns })
    }

    /// Number of lines.
    fn lines(&self) -> usize {
        self.table.len() / self.yarns
    }

    /// The link that begins on a line, of a yarn counted from the first one.
    fn get(&self, line: usize, yarn: usize) -> Option<OnYarn<'a>> {
        if yarn < self.yarns { self.table[line * self.yarns + yarn] } else { None }
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
        let mut packer = Packer { shape, classes: Vec::new() };
        let mut colours: Vec<(LinkFamily, Vec<Chain<P>>)> = Vec::new();
        let mut orders = Vec::new();
        for range in fabric.yarn_colours().ranges() {
            let yarns = &fabric.yarns()[range.clone()];
            let family = fabric.links()[yarns[0].links[0] as usize].family;
            for (direction, links) in by_direction(fabric, grid, yarns)? {
                colours.push((family, packer.pack(direction, &links)));
                orders.push(direction.order());
            }
        }
        let mut chains = Chains::of_colours(colours.into_iter());
        chains.cells = cells(&chains, shape);
        Some(Self { chains, orders, classes: packer.classes })
    }
}

/// The links of yarns of one colour, by direction; diagonals that cross between particles may share a colour.
/// None if a yarn does not run straight.
fn by_direction<'a>(
    fabric: &'a Fabric,
    grid: &Grid,
    yarns: &[Yarn],
) -> Option<BTreeMap<Direction, Links<'a>>> {
    let mut directions: BTreeMap<Direction, Vec<_>> = BTreeMap::new();
    for yarn in yarns {
        let direction = Direction::of(grid, yarn)?;
        let links = directions.entry(direction).or_default();
        for (index, (&particle, &link)) in yarn.particles.iter().zip(&yarn.links).enumerate() {
            let at = direction.line_and_yarn(grid, particle);
            links.push((at, (&fabric.links()[link as usize], index)));
        }
    }
    let links_of = |(direction, links): (Direction, Vec<_>)| Some((direction, Links::of(&links)?));
    directions.into_iter().map(links_of).collect()
}

/// The cells whose diagonals are links, one for each link of a pack of diagonals.
fn cells<P: Pack>(chains: &Chains<P>, shape: GridShape) -> Vec<Cell> {
    let stride = shape.row_stride as u32;
    let of_diagonal = |([above, below], target): ([u32; 2], u32)| {
        let left = if below > above + stride { above } else { above - 1 };
        Cell { corners: [left, left + 1, left + stride, left + stride + 1], targets: [target; 2] }
    };
    chains.diagonals().map(of_diagonal).collect()
}

/// Packs neighbouring yarns.
struct Packer {
    shape: GridShape,
    classes: Vec<LaneIndices>,
}

impl Packer {
    /// Packs the yarns of one direction, the longest first.
    fn pack<P: Pack>(&mut self, direction: Direction, links: &Links) -> Vec<Chain<P>> {
        let mut chains: Vec<Chain<P>> = (0..links.yarns)
            .step_by(<P as Pack>::WIDTH)
            .filter_map(|first| self.chain(direction, first, links))
            .collect();
        chains.sort_by_key(|chain| core::cmp::Reverse(chain.links.len()));
        chains
    }

    /// Packs neighbouring yarns from number `first` on; none if there are no links.
    fn chain<P: Pack>(
        &mut self,
        direction: Direction,
        first: usize,
        links: &Links,
    ) -> Option<Chain<P>> {
        let yarns = first..first + P::WIDTH;
        let is_linked = |&line: &usize| yarns.clone().any(|yarn| links.get(line, yarn).is_some());
        let begin = (0..links.lines()).find(is_linked)?;
        let end = (0..links.lines()).rfind(is_linked)? + 1;
        let mut chain_links = Vec::with_capacity(end - begin);
        let mut sweep = [Vec::new(), Vec::new()];
        for line in begin..end {
            let lanes: [Option<OnYarn>; MOST_LANES] =
                array::from_fn(
                    |lane| {
                        if lane < P::WIDTH { links.get(line, first + lane) } else { None }
                    },
                );
            let classes = lanes.map(|link| Some(link?.0.class));
            let class = self.class(classes);
            chain_links.push(ChainLink {
                class,
                rest_length: P::of(|lane| lanes[lane].map_or(0.0, |(link, _)| link.rest_length)),
            });
            // Even and odd links are counted from the beginning of each yarn, which pins may shift.
            for (parity, sweep) in sweep.iter_mut().enumerate() {
                let is_of = |lane: usize| lanes[lane].is_some_and(|(_, at)| at % 2 == parity);
                let of_parity = array::from_fn(|lane| classes[lane].filter(|_| is_of(lane)));
                if of_parity.iter().any(Option::is_some) {
                    sweep.push((line - begin, self.class(of_parity)));
                }
            }
        }
        let first = links.first + first as isize;
        let skewed = |line| first + direction.skew() * line as isize;
        let at = |line| self.shape.index(direction.order(), line, skewed(line));
        Some(Chain {
            particles: (begin..=end).map(at).collect(),
            links: chain_links,
            sweep_order: sweep.concat(),
        })
    }

    /// The class of links with these classes of the fabric in their lanes.
    fn class(&mut self, of_lanes: LaneIndices) -> u32 {
        // Neighbours mostly have equal classes, which are the last ones in the list.
        let known = self.classes.iter().rposition(|known| *known == of_lanes);
        known.unwrap_or_else(|| {
            self.classes.push(of_lanes);
            self.classes.len() - 1
        }) as u32
    }
}
