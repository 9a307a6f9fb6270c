//! The links at each particle, listed when somebody first asks for them.

use std::sync::OnceLock;

use super::links::Link;

/// For each particle, the indices of its links.
#[derive(Clone, Debug)]
struct LinksAt {
    /// Where the links of each particle begin in the list, and where the last ones end.
    starts: Vec<u32>,
    list: Vec<u32>,
}

impl LinksAt {
    fn new(links: &[Link], particles: usize) -> Self {
        let mut starts = vec![0; particles + 1];
        for particle in links.iter().flat_map(|link| link.particles) {
            starts[particle as usize + 1] += 1;
        }
        for particle in 0..particles {
            starts[particle + 1] += starts[particle];
        }
        let mut ends = starts.clone();
        let mut list = vec![0; 2 * links.len()];
        for (index, link) in links.iter().enumerate() {
            for particle in link.particles {
                let end = &mut ends[particle as usize];
                list[*end as usize] = index as u32;
                *end += 1;
            }
        }
        Self { starts, list }
    }

    fn of(&self, particle: u32) -> &[u32] {
        let at = particle as usize;
        &self.list[self.starts[at] as usize..self.starts[at + 1] as usize]
    }
}

/// The links at each particle; empty before any are asked for.
#[derive(Clone, Debug, Default)]
pub(super) struct KnownLinksAt(OnceLock<LinksAt>);

impl KnownLinksAt {
    /// Indices of the links at a particle, given all links and the number of particles.
    pub fn of(&self, particle: u32, links: &[Link], particles: usize) -> &[u32] {
        self.0.get_or_init(|| LinksAt::new(links, particles)).of(particle)
    }
}
