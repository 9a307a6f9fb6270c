//! Sparse rows of weights: places that are interpolated from others.

use core::ops::Range;

use glam::{Mat3, Vec3};

/// Weights smaller than this are rounding.
const LEAST_WEIGHT: f32 = 1e-5;

/// One term of an interpolated value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Term {
    /// Index of the particle.
    pub from: u32,
    pub weight: f32,
}

impl Term {
    /// The sum of some rows with their weights, in the order in which the particles occur.
    pub(in crate::fabric) fn sum<'a>(
        rows: impl IntoIterator<Item = (&'a [Self], f32)>,
    ) -> Vec<Self> {
        let mut sum: Vec<Self> = Vec::new();
        for (row, weight) in rows {
            for term in row {
                let weight = weight * term.weight;
                match sum.iter_mut().find(|known| known.from == term.from) {
                    Some(known) => known.weight += weight,
                    None => sum.push(Self { from: term.from, weight }),
                }
            }
        }
        sum
    }

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
}

/// The distance of a place from the surface between particles at rest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Height {
    /// The place.
    pub place: u32,
    /// Four particles around it, two opposite ones first. The vectors between opposite ones are tangents.
    pub around: [u32; 4],
    /// Coordinates along the two tangents, in units of these.
    pub along: [f32; 2],
    /// Coordinate along the unit vector product of the tangents, m.
    pub height: f32,
}

impl Height {
    /// How far a place lies away (m) from the surface between particles, given four of these and their positions; none if two
    /// opposite ones lie at one place.
    pub(super) fn of(
        place: u32,
        around: [u32; 4],
        [a, b, c, d]: [Vec3; 4],
        away: Vec3,
    ) -> Option<Self> {
        let frame = Mat3::from_cols(b - a, d - c, (b - a).cross(d - c).normalize_or_zero());
        let Vec3 { x, y, z } = frame.inverse() * away;
        let is_finite = x.is_finite() && y.is_finite() && z.is_finite();
        is_finite.then_some(Self { place, around, along: [x, y], height: z })
    }

    /// What is added to a place on the surface between particles, given their positions, m.
    pub(super) fn raise(&self, positions: &[Vec3]) -> Vec3 {
        let [a, b, c, d] = self.around.map(|at| positions[at as usize]);
        let (one, other) = (b - a, d - c);
        one * self.along[0]
            + other * self.along[1]
            + one.cross(other).normalize_or_zero() * self.height
    }
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
}
