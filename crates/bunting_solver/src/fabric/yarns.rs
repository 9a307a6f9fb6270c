//! Yarns: the links of any mesh cut into long straight paths.
//!
//! At each particle the links that run on most straightly are joined; a path ends where nothing
//! runs on. On a grid these are the rows, the columns and both diagonals. Every link lies in exactly
//! one yarn. The links of one yarn are solved together, exactly, in a tridiagonal system
//! (`constraints/yarn.rs`).

use glam::Vec3;

use super::colour::{Colours, colour};
use super::links::Link;

/// A path of links.
#[derive(Clone, Debug, PartialEq)]
pub struct Yarn {
    /// Particles along the path, one more than there are links.
    pub particles: Vec<u32>,
    /// Indices into [`Fabric::links`](super::Fabric::links), in the order of the path.
    pub links: Vec<u32>,
}

/// Two links run on into one another if they bend by less than this: 30°.
const STRAIGHT_COS: f32 = 0.866;

/// Cuts the links into yarns and colours these, warp first, so that yarns of one colour share no
/// particle. Within a colour, longer yarns come first: neighbours are then of one length.
pub(crate) fn yarns(rest: &[Vec3], links: &[Link]) -> (Vec<Yarn>, Colours) {
    let next = continuations(rest, links);
    let mut in_yarn = vec![false; links.len()];
    let mut yarns = Vec::new();
    for start in 0..links.len() {
        if in_yarn[start] {
            continue;
        }
        // Back to the path's beginning, or once around a ring.
        let mut first = End { link: start, at: 0 };
        while let Some(before) = next[first.link][first.at] {
            first = End { link: before.link, at: 1 - before.at };
            if first.link == start {
                break;
            }
        }
        let mut yarn =
            Yarn { particles: vec![links[first.link].particles[first.at]], links: Vec::new() };
        let mut entry = Some(first);
        while let Some(End { link, at }) = entry {
            if in_yarn[link] {
                break;
            }
            in_yarn[link] = true;
            let far = links[link].particles[1 - at];
            yarn.links.push(link as u32);
            // A ring is cut open: its last link, which would close it, is a yarn of its own.
            if yarn.particles.contains(&far) {
                yarn.links.pop();
                yarns.push(Yarn {
                    particles: links[link].particles.to_vec(),
                    links: vec![link as u32],
                });
                break;
            }
            yarn.particles.push(far);
            entry = next[link][1 - at];
        }
        yarns.push(yarn);
    }
    yarns.sort_by_key(|yarn| core::cmp::Reverse(yarn.links.len()));
    colour(rest.len(), yarns, |yarn| &yarn.particles, |yarn| family_rank(links, yarn))
}

/// One end of a link.
#[derive(Clone, Copy, PartialEq)]
struct End {
    link: usize,
    /// Which of the link's two particles.
    at: usize,
}

/// For each end of each link the end at which the next link of its yarn is entered.
fn continuations(rest: &[Vec3], links: &[Link]) -> Vec<[Option<End>; 2]> {
    let mut ends_at: Vec<Vec<End>> = vec![Vec::new(); rest.len()];
    for (link, joined) in links.iter().enumerate() {
        for at in 0..2 {
            ends_at[joined.particles[at] as usize].push(End { link, at });
        }
    }
    let outward = |end: End| {
        let [near, far] =
            [end.at, 1 - end.at].map(|at| rest[links[end.link].particles[at] as usize]);
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
            if next[one.link][one.at].is_none() && next[other.link][other.at].is_none() {
                next[one.link][one.at] = Some(other);
                next[other.link][other.at] = Some(one);
            }
        }
    }
    next
}

/// Warp before weft before bias.
fn family_rank(links: &[Link], yarn: &Yarn) -> u32 {
    links[yarn.links[0] as usize].family as u32
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

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

    #[test]
    fn a_tube_is_cut_open() {
        let around = 12;
        let ring = |height: f32| {
            (0..around).map(move |i| {
                let angle = core::f32::consts::TAU * i as f32 / around as f32;
                Vec3::new(libm::cosf(angle), height, libm::sinf(angle))
            })
        };
        let positions: Vec<Vec3> = ring(0.0).chain(ring(0.5)).collect();
        let indices = (0..around)
            .flat_map(|i| {
                let next = (i + 1) % around;
                [i, next, i + around, next, next + around, i + around]
            })
            .collect();
        let fabric = FabricBuilder::new(positions, indices).build().expect("a good fabric");
        covers_each_link_once(&fabric);
        assert!(fabric.yarns().iter().any(|yarn| yarn.links.len() == around as usize - 1));
    }
}
