//! Sparse rows of weights, from particles to the nodes of a grid and back.

use core::ops::Range;

use glam::Vec2;

use super::chart::node_positions;
use crate::fabric::grid::Grid;

/// Weights smaller than this are rounding.
const LEAST_WEIGHT: f32 = 1e-5;

/// Least barycentric coordinate of a node in the triangle that it is interpolated in. Larger: rounding loses nodes on
/// the border. Smaller: nodes outside the mesh are extrapolated from a single triangle.
const INSIDE: f32 = -0.02;

/// One term of an interpolated value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Term {
    /// Index of the particle, or of the node.
    pub from: u32,
    pub weight: f32,
}

impl Term {
    /// The term of a row with the greatest weight; none of an empty row.
    pub(in crate::fabric) fn heaviest(row: &[Self]) -> Option<&Self> {
        row.iter().max_by(|one, other| one.weight.total_cmp(&other.weight))
    }
}

/// For each row the terms of its interpolated value.
#[derive(Clone, Debug, Default)]
pub(crate) struct Interpolation {
    terms: Vec<Term>,
    rows: Vec<Range<u32>>,
    /// Empty until the rows are [grouped](Self::grouped).
    groups: Vec<RowGroup>,
}

/// Rows with the same number of terms: loops over their terms have a length that processors predict.
#[derive(Clone, Debug)]
pub(crate) struct RowGroup {
    /// Number of terms of each row.
    pub length: usize,
    /// The rows, in ascending order.
    pub rows: Vec<u32>,
    /// Indices of their terms, row by row.
    terms: Range<usize>,
}

impl Interpolation {
    /// Adds a row. Terms that are rounding are left out, and the others keep the sum of the weights: a sum that is 10⁻⁶
    /// too small moves particles a metre from the origin by 10⁻⁶ m, 4 % of the stretch of a stiff cloth.
    pub(in crate::fabric) fn push(&mut self, row: impl IntoIterator<Item = Term>) {
        let first = self.terms.len();
        let mut left_out = 0.0;
        for term in row {
            if term.weight.abs() > LEAST_WEIGHT {
                self.terms.push(term);
            } else {
                left_out += term.weight;
            }
        }
        let heaviest =
            self.terms[first..].iter_mut().max_by(|a, b| a.weight.abs().total_cmp(&b.weight.abs()));
        if let Some(heaviest) = heaviest {
            heaviest.weight += left_out;
        }
        self.rows.push(first as u32..self.terms.len() as u32);
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// The terms of a row.
    pub fn row(&self, row: usize) -> &[Term] {
        let Range { start, end } = self.rows[row].clone();
        &self.terms[start as usize..end as usize]
    }

    /// The rows, in order.
    pub fn rows(&self) -> impl Iterator<Item = &[Term]> {
        (0..self.len()).map(|row| self.row(row))
    }

    /// The same rows, with those of equal length grouped. Rows without terms are in no group.
    pub fn grouped(self) -> Self {
        let longest = self.rows.iter().map(|row| row.len()).max().unwrap_or(0);
        let mut grouped = Self { rows: vec![0..0; self.rows.len()], ..Self::default() };
        for length in 1..=longest {
            let rows = (0..).zip(&self.rows).filter(|(_, terms)| terms.len() == length);
            let rows: Vec<u32> = rows.map(|(row, _)| row).collect();
            if rows.is_empty() {
                continue;
            }
            let first = grouped.terms.len();
            for &row in &rows {
                let start = grouped.terms.len() as u32;
                let Range { start: from, end } = self.rows[row as usize].clone();
                grouped.terms.extend(&self.terms[from as usize..end as usize]);
                grouped.rows[row as usize] = start..grouped.terms.len() as u32;
            }
            grouped.groups.push(RowGroup { length, rows, terms: first..grouped.terms.len() });
        }
        grouped
    }

    /// Groups of rows of equal length.
    #[inline]
    pub fn groups(&self) -> &[RowGroup] {
        &self.groups
    }

    /// The terms of a group, row by row.
    #[inline]
    pub fn terms_of(&self, group: &RowGroup) -> &[Term] {
        &self.terms[group.terms.clone()]
    }

    /// The same rows, with columns numbered anew.
    pub fn with_columns(mut self, numbers: &[u32]) -> Self {
        self.terms.iter_mut().for_each(|term| term.from = numbers[term.from as usize]);
        self
    }

    /// The same rows, but for the second one of each pair, which becomes the first one.
    pub fn with_pairs_alike(mut self, pairs: &[[u32; 2]]) -> Self {
        for &[first, second] in pairs {
            self.rows[second as usize] = self.rows[first as usize].clone();
        }
        self
    }

    /// The same rows, each at its number among `count`, and grouped. The others are empty.
    pub fn with_rows_at(mut self, numbers: &[u32], count: usize) -> Self {
        let rows = core::mem::replace(&mut self.rows, vec![0..0; count]);
        for (row, &number) in rows.into_iter().zip(numbers) {
            self.rows[number as usize] = row;
        }
        self.grouped()
    }

    /// The same rows without the terms that are not `wanted`, each with the same sum of its weights.
    pub fn with_terms_of(&self, wanted: &[bool]) -> Self {
        let sum = |terms: &[Term]| terms.iter().map(|term| term.weight).sum::<f32>();
        let mut all = Self::default();
        for row in self.rows() {
            let kept = row.iter().copied().filter(|term| wanted[term.from as usize]);
            let kept: Vec<Term> = kept.collect();
            let factor = sum(row) / sum(&kept);
            all.push(kept.iter().map(|term| Term { weight: term.weight * factor, ..*term }));
        }
        all
    }

    /// The rows that are `wanted`. The others are empty.
    pub fn rows_where(&self, wanted: impl Fn(usize) -> bool) -> Self {
        let mut rows = Self::default();
        for (index, row) in self.rows().enumerate() {
            rows.push(if wanted(index) { row } else { &[] }.iter().copied());
        }
        rows
    }

    /// One row for each of `count` numbers: the mean of the rows that have this number and terms.
    pub fn mean_rows(&self, numbers: &[u32], count: usize) -> Self {
        let mut rows = vec![Vec::new(); count];
        for (row, &number) in self.rows().zip(numbers).filter(|(row, _)| !row.is_empty()) {
            rows[number as usize].push(row);
        }
        let mut means = Self::default();
        for rows in rows {
            let part = 1.0 / rows.len() as f32;
            let terms = rows.into_iter().flatten();
            means.push(terms.map(|term| Term { weight: term.weight * part, ..*term }));
        }
        means
    }

    /// For each column the mean of the rows' values, weighted by their weights times a mass of the row. `sums` are the
    /// sums of these weights, and only columns that are `wanted` get a mean.
    pub fn adjoint(&self, masses: &[f32], sums: &[f32], wanted: impl Fn(usize) -> bool) -> Self {
        let mut columns = vec![Vec::new(); sums.len()];
        for (index, (row, mass)) in self.rows().zip(masses).enumerate() {
            for term in row.iter().filter(|term| wanted(term.from as usize)) {
                let column = term.from as usize;
                let weight = term.weight * mass / sums[column];
                columns[column].push(Term { from: index as u32, weight });
            }
        }
        let mut adjoint = Self::default();
        columns.into_iter().for_each(|column| adjoint.push(column));
        adjoint
    }

    /// For each of `count` columns the sum of weights times a value of the row.
    pub fn transposed_product(&self, values: &[f32], count: usize) -> Vec<f32> {
        let mut sums = vec![0.0; count];
        for (row, value) in self.rows().zip(values) {
            for term in row {
                sums[term.from as usize] += term.weight * value;
            }
        }
        sums
    }
}

/// Weights of the particles at each node: barycentric in the triangle that the node lies in. Rows of nodes outside the
/// mesh are empty.
pub(super) fn nodes_from_particles(
    positions: &[Vec2],
    triangles: &[[u32; 3]],
    grid: &Grid,
) -> Interpolation {
    let mut weights = Interpolation::default();
    for within in barycentric(positions, triangles, &node_positions(grid), grid) {
        let within = within.filter(|(least, _)| *least > INSIDE);
        weights.push(within.into_iter().flat_map(|(_, terms)| terms));
    }
    weights
}

/// For each node the triangle in which its least barycentric coordinate is greatest, of those near it: that coordinate
/// and the terms.
fn barycentric(
    positions: &[Vec2],
    triangles: &[[u32; 3]],
    nodes: &[Vec2],
    grid: &Grid,
) -> Vec<Option<(f32, [Term; 3])>> {
    let spacing = Vec2::from(grid.spacing());
    let mut best: Vec<Option<(f32, [Term; 3])>> = vec![None; nodes.len()];
    for triangle in triangles {
        let [a, b, c] = triangle.map(|corner| positions[corner as usize]);
        let double_area = (b - a).perp_dot(c - a);
        // A hundredth of a cell wider than the triangle, as nodes on the border are off by rounding.
        let low = (a.min(b).min(c) / spacing - 0.01).ceil().max(Vec2::ZERO);
        let high = a.max(b).max(c) / spacing + 0.01;
        for row in low.y as u32..=(high.y as u32).min(grid.rows - 1) {
            for column in low.x as u32..=(high.x as u32).min(grid.columns - 1) {
                let node = grid.index(column, row) as usize;
                let at = nodes[node];
                let weights = [
                    (b - at).perp_dot(c - at) / double_area,
                    (c - at).perp_dot(a - at) / double_area,
                    (a - at).perp_dot(b - at) / double_area,
                ];
                let least = weights[0].min(weights[1]).min(weights[2]);
                if best[node].is_none_or(|(greatest, _)| least > greatest) {
                    let term =
                        |corner: usize| Term { from: triangle[corner], weight: weights[corner] };
                    best[node] = Some((least, [term(0), term(1), term(2)]));
                }
            }
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::{Interpolation, Term};

    fn row(weights: &[f32]) -> Vec<Term> {
        (0..).zip(weights).map(|(from, &weight)| Term { from, weight }).collect()
    }

    #[test]
    fn a_row_keeps_the_sum_of_its_weights() {
        let mut rows = Interpolation::default();
        rows.push(row(&[4e-6, 0.5, 0.499_996]));
        let [kept] = &rows.rows().collect::<Vec<_>>()[..] else { panic!("one row") };
        assert_eq!(kept.len(), 2, "a weight of 4 · 10⁻⁶ is rounding");
        let sum: f32 = kept.iter().map(|term| term.weight).sum();
        assert!((sum - 1.0).abs() < 2.0 * f32::EPSILON, "{sum}");
    }

    #[test]
    fn grouped_rows_are_the_same_rows() {
        let mut rows = Interpolation::default();
        for weights in [&[0.5, 0.5][..], &[], &[1.0], &[0.25, 0.75], &[0.2, 0.3, 0.5]] {
            rows.push(row(weights));
        }
        let grouped = rows.clone().grouped();
        assert!(rows.rows().eq(grouped.rows()));
        let groups: Vec<(usize, &[u32], usize)> = grouped
            .groups()
            .iter()
            .map(|group| (group.length, &group.rows[..], grouped.terms_of(group).len()))
            .collect();
        assert_eq!(groups, [(1, &[2][..], 1), (2, &[0, 3], 4), (3, &[4], 3)]);
    }
}
