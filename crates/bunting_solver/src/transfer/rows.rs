//! A sparse matrix from coarse to fine particles.

use core::ops::{Add, Mul};

/// For each fine particle, coarse ones with weights whose sum is one.
#[derive(Clone, Debug, Default)]
pub(super) struct Rows {
    /// Where each row ends in `entries`.
    ends: Vec<usize>,
    entries: Vec<(u32, f32)>,
}

impl Rows {
    pub fn push(&mut self, row: impl IntoIterator<Item = (u32, f32)>) {
        self.entries.extend(row);
        self.ends.push(self.entries.len());
    }

    /// The rows in order.
    pub fn iter(&self) -> impl Iterator<Item = &[(u32, f32)]> {
        let mut start = 0;
        self.ends.iter().map(move |&end| {
            let row = &self.entries[start..end];
            start = end;
            row
        })
    }

    /// The weighted mean of coarse values at each fine particle.
    pub fn interpolate<T>(&self, coarse: &[T]) -> impl Iterator<Item = T>
    where
        T: Copy + Default + Add<Output = T> + Mul<f32, Output = T>,
    {
        self.iter().map(|row| {
            let terms = row.iter().map(|&(parent, weight)| coarse[parent as usize] * weight);
            terms.reduce(Add::add).unwrap_or_default()
        })
    }

    /// The transposed product: adds each fine value to its coarse particles, by their weights.
    pub fn gather<T>(&self, fine: impl IntoIterator<Item = T>, coarse: usize) -> Vec<T>
    where
        T: Copy + Default + Add<Output = T> + Mul<f32, Output = T>,
    {
        let mut sums = vec![T::default(); coarse];
        for (row, value) in self.iter().zip(fine) {
            for &(parent, weight) in row {
                sums[parent as usize] = sums[parent as usize] + value * weight;
            }
        }
        sums
    }
}
