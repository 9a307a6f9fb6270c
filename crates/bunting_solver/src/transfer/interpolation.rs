//! A sparse matrix from the values of coarse particles to those of fine particles.

use core::ops::{Add, Mul};

/// For each fine particle a row of coarse particles with interpolation weights, whose sum is one.
#[derive(Clone, Debug, Default)]
pub(super) struct Interpolation {
    /// End of each row in `entries`.
    ends: Vec<usize>,
    entries: Vec<(u32, f32)>,
}

impl Interpolation {
    /// Adds the row of the next fine particle.
    pub fn push(&mut self, row: impl IntoIterator<Item = (u32, f32)>) {
        self.entries.extend(row);
        self.ends.push(self.entries.len());
    }

    /// The rows, one for each fine particle.
    pub fn rows(&self) -> impl Iterator<Item = &[(u32, f32)]> {
        let mut start = 0;
        self.ends.iter().map(move |&end| {
            let row = &self.entries[start..end];
            start = end;
            row
        })
    }

    /// The product with coarse values: their weighted mean at each fine particle.
    pub fn interpolate<T>(&self, coarse: &[T]) -> impl Iterator<Item = T>
    where
        T: Copy + Default + Add<Output = T> + Mul<f32, Output = T>,
    {
        self.rows().map(|row| {
            let terms = row.iter().map(|&(parent, weight)| coarse[parent as usize] * weight);
            terms.reduce(Add::add).unwrap_or_default()
        })
    }

    /// The transposed product with fine values: each value is distributed over the coarse particles of its
    /// row. `count` is the number of coarse particles.
    pub fn gather<T>(&self, fine: impl IntoIterator<Item = T>, count: usize) -> Vec<T>
    where
        T: Copy + Default + Add<Output = T> + Mul<f32, Output = T>,
    {
        let mut sums = vec![T::default(); count];
        for (row, value) in self.rows().zip(fine) {
            for &(parent, weight) in row {
                sums[parent as usize] = sums[parent as usize] + value * weight;
            }
        }
        sums
    }
}
