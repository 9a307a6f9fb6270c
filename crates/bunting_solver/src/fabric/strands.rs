//! Yarns laid out for the order in which they are solved: two abreast.
//!
//! Solving a yarn is one long chain of divisions, each waiting on the last; yarns of one colour do
//! not wait on one another. So they are solved side by side, and stored interleaved. A shorter yarn
//! is drawn out to the length of its neighbours by links from its last particle to itself, which
//! pull nothing.

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
}

/// A link as it is solved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StrandLink {
    /// Index into the fabric's links; one past the last for a link that only fills.
    pub link: u32,
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

/// Lays yarns side by side, colour by colour.
pub(crate) fn strands(
    yarns: &[Yarn],
    colours: &Colours,
    links: &[Link],
) -> (Vec<Strand>, Vec<StrandColour>) {
    let mut strands: Vec<Strand> = Vec::new();
    let mut coloured = Vec::new();
    for range in colours.ranges() {
        let first = strands.len();
        let family = links[yarns[range.start].links[0] as usize].family;
        strands.extend(yarns[range.clone()].chunks(ABREAST).map(|side| Strand::new(side, links)));
        coloured.push(StrandColour { family, strands: first..strands.len() });
    }
    (strands, coloured)
}

impl Strand {
    fn new(yarns: &[Yarn], links: &[Link]) -> Self {
        let rows = yarns.iter().map(|yarn| yarn.links.len()).max().unwrap_or(0);
        let column = |at: usize| &yarns[at.min(yarns.len() - 1)];
        let particles = (0..=rows).map(|row| {
            core::array::from_fn(|at| {
                let path = &column(at).particles;
                path[row.min(path.len() - 1)]
            })
        });
        let links = (0..rows).map(|row| {
            core::array::from_fn(|at| match column(at).links.get(row) {
                Some(&link) => StrandLink {
                    link,
                    class: links[link as usize].class,
                    rest_length: links[link as usize].rest_length,
                },
                None => StrandLink { link: links.len() as u32, class: 0, rest_length: 0.0 },
            })
        });
        Self { count: yarns.len(), particles: particles.collect(), links: links.collect() }
    }
}
