//! Yarns laid out for the order in which they are solved: two abreast.
//!
//! Solving a yarn is one long chain of divisions, each waiting on the last; yarns of one colour do
//! not wait on one another. So they are solved side by side, and stored interleaved. A shorter yarn
//! is drawn out to the length of its neighbours by links from its last particle to itself, which
//! have no direction and pull nothing.

use core::ops::Range;

use super::colour::Colours;
use super::links::{Link, LinkFamily};
use super::yarns::Yarn;

/// How many yarns lie side by side. Three or four no longer fit into the registers, and were slower
/// at every width but one.
pub(crate) const ABREAST: usize = 2;

/// Yarns of one colour side by side.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Strand {
    /// How many yarns there are; in rows, the columns from here on mean nothing.
    pub count: usize,
    /// Rows of particles, one more than there are rows of links.
    pub particles: Vec<[u32; ABREAST]>,
    /// Rows of links.
    pub links: Vec<[StrandLink; ABREAST]>,
    /// Where among all targets those of its links are: row by row, `count` a row.
    pub targets: Range<usize>,
}

/// A link as it is solved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StrandLink {
    /// Index into the fabric's link classes.
    pub class: u32,
    /// Distance at rest, m.
    pub rest_length: f32,
}

/// Strands of one colour.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct StrandColour {
    pub family: LinkFamily,
    pub strands: Range<usize>,
}

/// All yarns of a fabric, laid side by side.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Strands {
    /// Colour by colour.
    pub strands: Vec<Strand>,
    pub colours: Vec<StrandColour>,
    /// Warp and weft link by link, yarn after yarn: in each, every second link and then the others,
    /// so that neighbours in the list share no particle.
    pub polish: Vec<PolishLink>,
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
        let mut strands: Vec<Strand> = Vec::new();
        let mut coloured = Vec::new();
        let mut polish = Vec::new();
        for range in colours.ranges() {
            let first = strands.len();
            let family = links[yarns[range.start].links[0] as usize].family;
            for side in yarns[range.clone()].chunks(ABREAST) {
                let targets = strands.last().map_or(0, |strand| strand.targets.end);
                strands.push(Strand::new(side, links, targets));
                if family == LinkFamily::Bias {
                    continue;
                }
                for (at, yarn) in side.iter().enumerate() {
                    let count = yarn.links.len();
                    polish.extend((0..count).step_by(2).chain((1..count).step_by(2)).map(|row| {
                        let Link { particles, class, .. } = links[yarn.links[row] as usize];
                        let target = (targets + row * side.len() + at) as u32;
                        PolishLink { particles, class, target }
                    }));
                }
            }
            coloured.push(StrandColour { family, strands: first..strands.len() });
        }
        Self { strands, colours: coloured, polish }
    }

    /// Number of targets, those of links that only fill included.
    pub fn target_count(&self) -> usize {
        self.strands.last().map_or(0, |strand| strand.targets.end)
    }
}

impl Strand {
    fn new(yarns: &[Yarn], links: &[Link], first_target: usize) -> Self {
        let rows = yarns.iter().map(|yarn| yarn.links.len()).max().unwrap_or(0);
        let column = |at: usize| &yarns[at.min(yarns.len() - 1)];
        let particles = (0..=rows).map(|row| {
            core::array::from_fn(|at| {
                let path = &column(at).particles;
                path[row.min(path.len() - 1)]
            })
        });
        let link_rows = (0..rows).map(|row| {
            core::array::from_fn(|at| {
                let path = &column(at).links;
                let Link { class, rest_length, .. } = links[path[row.min(path.len() - 1)] as usize];
                StrandLink { class, rest_length }
            })
        });
        let particles = particles.collect();
        let links: Vec<[StrandLink; ABREAST]> = link_rows.collect();
        Self {
            count: yarns.len(),
            particles,
            links,
            targets: first_target..first_target + rows * yarns.len(),
        }
    }
}
