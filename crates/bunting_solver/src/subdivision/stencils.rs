//! Sparse rows of weights.

use glam::Vec3A;

/// Values as weighted sums of other values: one row of weights for each.
#[derive(Clone, Debug, Default)]
pub struct Stencils {
    /// End of each row among the terms.
    ends: Vec<u32>,
    terms: Vec<(u32, f32)>,
}

impl Stencils {
    /// One row for each value: the value itself.
    pub(super) fn identity(count: u32) -> Self {
        Self { ends: (1..=count).collect(), terms: (0..count).map(|at| (at, 1.0)).collect() }
    }

    /// Appends a row. Terms of the same value are added up.
    pub(super) fn push(&mut self, row: impl IntoIterator<Item = (u32, f32)>) {
        let begin = self.terms.len();
        self.terms.extend(row);
        self.terms[begin..].sort_unstable_by_key(|term| term.0);
        let mut last = begin;
        for at in begin + 1..self.terms.len() {
            let term = self.terms[at];
            if self.terms[last].0 == term.0 {
                self.terms[last].1 += term.1;
            } else {
                last += 1;
                self.terms[last] = term;
            }
        }
        self.terms.truncate((last + 1).min(self.terms.len()));
        self.ends.push(self.terms.len() as u32);
    }

    /// The terms of a row: indices of values, with their weights.
    #[must_use]
    pub fn row(&self, index: u32) -> &[(u32, f32)] {
        let begin = index.checked_sub(1).map_or(0, |before| self.ends[before as usize]);
        &self.terms[begin as usize..self.ends[index as usize] as usize]
    }

    /// The rows, each as terms.
    pub fn rows(&self) -> impl ExactSizeIterator<Item = &[(u32, f32)]> + '_ {
        (0..self.ends.len() as u32).map(|index| self.row(index))
    }

    /// A row of values that are themselves sums by these stencils, as a row of what these stencils sum.
    pub(super) fn expand(&self, row: &[(u32, f32)]) -> Vec<(u32, f32)> {
        let scaled = |&(value, by): &(u32, f32)| {
            self.row(value).iter().map(move |&(index, weight)| (index, weight * by))
        };
        row.iter().flat_map(scaled).collect()
    }

    /// Writes the sum of each row.
    pub(super) fn apply(&self, values: &[Vec3A], into: &mut Vec<Vec3A>) {
        let mut begin = 0;
        let sum = |&end: &u32| {
            let row = &self.terms[begin..end as usize];
            begin = end as usize;
            row.iter().map(|&(index, weight)| values[index as usize] * weight).sum::<Vec3A>()
        };
        into.clear();
        into.extend(self.ends.iter().map(sum));
    }
}
