//! The factorised systems of bend lines.
//!
//! With one row of D a particle's stencil (1, −2, 1)/l, W the inverse masses and α̃ the compliances over the
//! rows' weights, the XPBD system of a line is the pentadiagonal D W Dᵀ + α̃. It is constant over many
//! substeps and factorised as L D Lᵀ, L having ones on its diagonal and two bands below it.

use crate::fabric::BendProfile;
use crate::simd::constant::{Constant, PerLane};
use crate::simd::lane::Pack;

/// The factors of the lines of a profile.
#[derive(Clone, Debug)]
pub(crate) struct BendFactors<P: Pack, C> {
    /// One row for each particle of a line other than its ends.
    pub rows: Vec<BendRow<P>>,
    /// Displacement of each particle of a line by a unit moment: its inverse mass over the spacing squared,
    /// 1/m⁴.
    pub mobilities: Vec<C>,
}

/// A row of the factors.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BendRow<T> {
    /// Element of L one left of the diagonal.
    pub first_lower: T,
    /// Element of L two left of the diagonal.
    pub second_lower: T,
    /// One over the element of D; zero in lanes without a line, which makes their moments zero.
    pub inverse_diagonal: T,
}

impl<P: Pack, C: Constant<P>> BendFactors<P, C> {
    /// Factors that are computed later, given the profile of each lane of a cloth. Shorter profiles are filled up by what nothing
    /// moves.
    pub fn new(profiles: &[Option<&BendProfile>]) -> Self {
        let zero = P::splat(0.0);
        let row = BendRow { first_lower: zero, second_lower: zero, inverse_diagonal: zero };
        let longest = profiles.iter().flatten().max_by_key(|profile| profile.inverse_areas.len());
        let mobility = |lane: usize, particle: usize| {
            let profile = profiles[lane].filter(|it| particle < it.inverse_areas.len());
            profile.map_or(0.0, |profile| mobility(profile, particle))
        };
        let particles = longest.map_or(0, |profile| profile.inverse_areas.len());
        Self {
            rows: vec![row; longest.map_or(0, |profile| profile.coefficients.len())],
            mobilities: (0..particles)
                .map(|particle| C::of(|lane| mobility(lane, particle)))
                .collect(),
        }
    }

    /// Overwrites the rows of one lane.
    pub fn set_lane(&mut self, lane: usize, rows: &[BendRow<f32>]) {
        for (packs, row) in self.rows.iter_mut().zip(rows) {
            packs.first_lower.lanes_mut()[lane] = row.first_lower;
            packs.second_lower.lanes_mut()[lane] = row.second_lower;
            packs.inverse_diagonal.lanes_mut()[lane] = row.inverse_diagonal;
        }
    }
}

impl<P: Pack> BendFactors<P, PerLane<P>> {
    /// Takes over the profile of one lane. Its rows are yet to be computed.
    pub fn set_profile(&mut self, lane: usize, profile: &BendProfile) {
        for (particle, pack) in self.mobilities.iter_mut().enumerate() {
            pack.set_lane(lane, mobility(profile, particle));
        }
    }
}

/// How far a unit moment moves a particle of a line, 1/m⁴.
fn mobility(profile: &BendProfile, particle: usize) -> f32 {
    let per_spacing = profile.inverse_spacing;
    profile.inverse_areas[particle] * per_spacing * per_spacing
}

/// Factorises the system of a profile, given the compliance of a row of unit weight, 1/m⁴. In double
/// precision, as it is done once for many substeps.
pub(crate) fn factorise(profile: &BendProfile, compliance: f32) -> Vec<BendRow<f32>> {
    let per_spacing = f64::from(profile.inverse_spacing);
    let mobilities: Vec<f64> = profile
        .inverse_areas
        .iter()
        .map(|&inverse_area| f64::from(inverse_area) * per_spacing * per_spacing)
        .collect();
    // Values of the last two rows: one over the diagonal, and the element of L one left of it.
    let (mut last, mut before_last) = ((0.0, 0.0), (0.0, 0.0));
    let row = |(row, &weight): (usize, &f32)| {
        let softness = softness(compliance, weight);
        let diagonal = mobilities[row] + 4.0 * mobilities[row + 1] + mobilities[row + 2] + softness;
        let first_band =
            if row >= 1 { -2.0 * (mobilities[row] + mobilities[row + 1]) } else { 0.0 };
        let second_band = if row >= 2 { mobilities[row] } else { 0.0 };
        let second_lower = second_band * before_last.0;
        let coupling = first_band - second_band * last.1;
        let first_lower = coupling * last.0;
        let pivot = diagonal - second_band * second_lower - first_lower * coupling;
        (before_last, last) = (last, (1.0 / pivot, first_lower));
        BendRow { first_lower, second_lower, inverse_diagonal: 1.0 / pivot }
    };
    let rows = profile.coefficients.iter().enumerate().map(row);
    let single = |row: BendRow<f64>| BendRow {
        first_lower: row.first_lower as f32,
        second_lower: row.second_lower as f32,
        inverse_diagonal: row.inverse_diagonal as f32,
    };
    rows.map(single).collect()
}

/// Compliance of a row of a weight, 1/m⁴; infinite where there is nothing that bends.
fn softness(compliance: f32, weight: f32) -> f64 {
    if weight > 0.0 { f64::from(compliance) / f64::from(weight) } else { f64::INFINITY }
}
