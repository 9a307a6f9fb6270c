//! Sums over the triangles or cells at each edge.

use super::topology::ascending;

/// A sum for each edge, found by the ends of the edge.
pub(super) struct EdgeSums<S> {
    /// The last sum of the edges whose lower end is each particle.
    last: Vec<Option<u32>>,
    sums: Vec<EdgeSum<S>>,
}

struct EdgeSum<S> {
    ends: [u32; 2],
    sum: S,
    /// The sum before of an edge with the same lower end.
    before: Option<u32>,
}

impl<S> EdgeSums<S> {
    pub fn new(particles: usize) -> Self {
        Self { last: vec![None; particles], sums: Vec::new() }
    }

    /// The sum of the edge between two particles, which begins as `none`.
    pub fn at(&mut self, ends: [u32; 2], none: impl FnOnce() -> S) -> &mut S {
        let ends = ascending(ends);
        let last = &mut self.last[ends[0] as usize];
        let mut known = *last;
        while let Some(index) = known {
            let sum = &self.sums[index as usize];
            if sum.ends == ends {
                break;
            }
            known = sum.before;
        }
        let index = known.unwrap_or_else(|| {
            let index = self.sums.len() as u32;
            self.sums.push(EdgeSum { ends, sum: none(), before: last.replace(index) });
            index
        });
        &mut self.sums[index as usize].sum
    }

    /// The ends of the edges, the lower one first, and their sums, sorted by the ends.
    pub fn sorted(mut self) -> impl Iterator<Item = ([u32; 2], S)> {
        self.sums.sort_unstable_by_key(|sum| sum.ends);
        self.sums.into_iter().map(|EdgeSum { ends, sum, .. }| (ends, sum))
    }
}
