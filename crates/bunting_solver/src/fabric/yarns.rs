//! Yarns: long straight paths of links of a grid.
//!
//! At each particle the straightest pairs of links are joined; a path ends where no link continues it. The paths
//! are the rows, the columns and both diagonals. Every link belongs to exactly one yarn. The
//! links of one yarn are solved together, exactly, as a tridiagonal system (`constraints/chain.rs`).

use glam::Vec3;

use super::colour::{Colours, colour};
use super::links::Link;

/// A path of links.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Yarn {
    /// Particles along the path, one more than links.
    pub particles: Vec<u32>,
    /// Indices of the links, in the order of the path.
    pub links: Vec<u32>,
}

impl Yarn {
    /// Whether it ends where it begins.
    pub(crate) fn is_ring(&self) -> bool {
        self.particles.first() == self.particles.last()
    }
}

/// The yarns of a fabric.
#[derive(Clone, Debug, Default)]
pub(crate) struct Yarns {
    /// Yarns, colour by colour, warp first; in each colour the longer yarns first, so that neighbours in the
    /// list have similar lengths.
    pub list: Vec<Yarn>,
    /// Ranges of yarns that share no particle.
    pub colours: Colours,
}

/// Cosine of the angle between two links above which one continues the other: 30°.
const STRAIGHT_COS: f32 = 0.866;

impl Yarns {
    /// Joins links to yarns, given the positions at rest, m.
    pub(super) fn of(rest: &[Vec3], links: &[Link]) -> Self {
        let next = continuations(rest, links);
        let mut in_yarn = vec![false; links.len()];
        let mut yarns = Vec::new();
        for start in 0..links.len() {
            if !in_yarn[start] {
                let first = first_end(&next, start);
                follow(links, &next, first, &mut in_yarn, &mut yarns);
            }
        }
        Self::coloured(yarns, links, rest.len())
    }

    /// Gives the yarns of each family colours by themselves, so that a family has few, the longest first.
    pub(super) fn coloured_by_family(
        mut yarns: Vec<Yarn>,
        links: &[Link],
        particle_count: usize,
    ) -> Self {
        let family = |yarn: &Yarn| links[yarn.links[0] as usize].family as u32;
        yarns.sort_by_key(|yarn| (family(yarn), core::cmp::Reverse(yarn.links.len())));
        let mut all = Self::default();
        for of_family in yarns.chunk_by(|one, other| family(one) == family(other)) {
            let of_family = Self::coloured(of_family.to_vec(), links, particle_count);
            all.colours.extend(&of_family.colours);
            all.list.extend(of_family.list);
        }
        all
    }

    /// Gives yarns colours, the longest first.
    pub(super) fn coloured(mut yarns: Vec<Yarn>, links: &[Link], particle_count: usize) -> Self {
        yarns.sort_by_key(|yarn| core::cmp::Reverse(yarn.links.len()));
        let family = |yarn: &Yarn| links[yarn.links[0] as usize].family as u32;
        let (list, colours) = colour(particle_count, yarns, |yarn| &yarn.particles, family);
        Self { list, colours }
    }
}

/// One end of a link.
#[derive(Clone, Copy, PartialEq)]
struct End {
    link: usize,
    /// Index (0 or 1) of the end's particle in the link.
    side: usize,
}

/// For each end of each link: the end at which the yarn enters the next link.
type Continuations = Vec<[Option<End>; 2]>;

/// Joins the ends at each particle, the straightest pair first.
fn continuations(rest: &[Vec3], links: &[Link]) -> Continuations {
    let mut ends_at: Vec<Vec<End>> = vec![Vec::new(); rest.len()];
    for (link, joined) in links.iter().enumerate() {
        for side in 0..2 {
            ends_at[joined.particles[side] as usize].push(End { link, side });
        }
    }
    let outward = |end: End| {
        let [near, far] =
            [end.side, 1 - end.side].map(|side| rest[links[end.link].particles[side] as usize]);
        (far - near).normalize()
    };
    let mut next = vec![[None; 2]; links.len()];
    for ends in ends_at {
        let mut pairs: Vec<(f32, End, End)> = Vec::new();
        for (index, &one) in ends.iter().enumerate() {
            for &other in &ends[index + 1..] {
                let straightness = -outward(one).dot(outward(other));
                if straightness > STRAIGHT_COS {
                    pairs.push((straightness, one, other));
                }
            }
        }
        pairs.sort_by(|a, b| b.0.total_cmp(&a.0));
        for (_, one, other) in pairs {
            if next[one.link][one.side].is_none() && next[other.link][other.side].is_none() {
                next[one.link][one.side] = Some(other);
                next[other.link][other.side] = Some(one);
            }
        }
    }
    next
}

/// The end at which the path through a link begins: found by following the path backwards.
fn first_end(next: &Continuations, start: usize) -> End {
    let mut first = End { link: start, side: 0 };
    while let Some(before) = next[first.link][first.side] {
        first = End { link: before.link, side: 1 - before.side };
    }
    first
}

/// Adds the yarn that begins at an end, and marks its links as used.
fn follow(
    links: &[Link],
    next: &Continuations,
    first: End,
    in_yarn: &mut [bool],
    yarns: &mut Vec<Yarn>,
) {
    let mut yarn =
        Yarn { particles: vec![links[first.link].particles[first.side]], links: Vec::new() };
    let mut entry = Some(first);
    while let Some(End { link, side }) = entry {
        in_yarn[link] = true;
        let far = links[link].particles[1 - side];
        yarn.links.push(link as u32);
        yarn.particles.push(far);
        entry = next[link][1 - side];
    }
    yarns.push(yarn);
}

#[cfg(test)]
mod tests {
    use crate::fabric::{Fabric, FabricBuilder, Grid, LinkFamily};

    fn covers_each_link_once(fabric: &Fabric) {
        let mut seen = vec![0; fabric.links().len()];
        for yarn in fabric.yarns() {
            assert_eq!(yarn.particles.len(), yarn.links.len() + 1);
            for (ends, &link) in yarn.particles.windows(2).zip(&yarn.links) {
                seen[link as usize] += 1;
                let [a, b] = fabric.links()[link as usize].particles;
                assert!(ends == [a, b] || ends == [b, a]);
            }
        }
        assert!(seen.iter().all(|&count| count == 1), "{seen:?}");
        for range in fabric.yarn_colours().ranges() {
            let mut particles: Vec<u32> = fabric.yarns()[range.clone()]
                .iter()
                .flat_map(|yarn| yarn.particles.clone())
                .collect();
            let all = particles.len();
            particles.sort_unstable();
            particles.dedup();
            assert_eq!(particles.len(), all, "yarns of one colour share a particle");
        }
    }

    #[test]
    fn a_grid_falls_into_rows_columns_and_diagonals() {
        let (columns, rows) = (9, 6);
        let fabric =
            FabricBuilder::grid(Grid::new(columns, rows, 1.0, 0.7)).build().expect("a good fabric");
        covers_each_link_once(&fabric);
        let count = |family, length| {
            let is = |yarn: &&super::Yarn| {
                fabric.links()[yarn.links[0] as usize].family == family
                    && yarn.links.len() == length
            };
            fabric.yarns().iter().filter(is).count()
        };
        assert_eq!(count(LinkFamily::Warp, 8), 6);
        assert_eq!(count(LinkFamily::Weft, 5), 9);
        assert_eq!(fabric.yarn_colours().ranges().len(), 4);
        assert_eq!(fabric.yarns().len(), 6 + 9 + 2 * (8 + 5 - 1));
    }

    #[test]
    fn pins_cut_yarns() {
        let grid = FabricBuilder::grid(Grid::new(5, 5, 1.0, 1.0));
        let fabric = grid.pin_where(|_, uv| uv.y == 0.0).build().expect("a good fabric");
        covers_each_link_once(&fabric);
    }
}
