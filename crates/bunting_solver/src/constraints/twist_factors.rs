//! The factorised systems of ribbons.
//!
//! With one row of J a cell's C = x₀₀ − x₁₀ − x₀₁ + x₁₁, W the inverse masses and α̃ the compliance of a cell,
//! the XPBD system of a ribbon is the tridiagonal J W Jᵀ + α̃. It is constant over many substeps and
//! factorised as L D Lᵀ, L having ones on its diagonal and one band below it.

use crate::fabric::RibbonProfile;
use crate::simd::constant::{Constant, PerLane};
use crate::simd::lane::Pack;

/// The factors of the ribbons of a profile.
#[derive(Clone, Debug)]
pub(crate) struct TwistFactors<P: Pack, C> {
    /// One row for each cell of a ribbon.
    pub rows: Vec<TwistRow<P>>,
    /// Inverse masses of the particles of each pair across a ribbon, 1/m².
    pub inverse_masses: Vec<[C; 2]>,
}

/// A row of the factors.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TwistRow<T> {
    /// Element of L left of the diagonal.
    pub lower: T,
    /// One over the element of D; zero in lanes without a ribbon, and in cloths that do not resist twist.
    pub inverse_diagonal: T,
}

impl<P: Pack, C: Constant<P>> TwistFactors<P, C> {
    /// Factors that are computed later, given the profile of each lane of a cloth; all profiles have the same
    /// length.
    pub fn new(profiles: &[Option<&RibbonProfile>]) -> Self {
        let zero = P::splat(0.0);
        let first = profiles.iter().flatten().next();
        let pairs = first.map_or(0, |profile| profile.inverse_areas.len());
        let inverse_mass = |lane: usize, pair: usize, side: usize| {
            profiles[lane].map_or(0.0, |profile| profile.inverse_areas[pair][side])
        };
        let of_pair = |pair: usize| [0, 1].map(|side| C::of(|lane| inverse_mass(lane, pair, side)));
        Self {
            rows: vec![TwistRow { lower: zero, inverse_diagonal: zero }; pairs.saturating_sub(1)],
            inverse_masses: (0..pairs).map(of_pair).collect(),
        }
    }

    /// Overwrites the rows of one lane.
    pub fn set_lane(&mut self, lane: usize, rows: &[TwistRow<f32>]) {
        for (packs, row) in self.rows.iter_mut().zip(rows) {
            packs.lower.lanes_mut()[lane] = row.lower;
            packs.inverse_diagonal.lanes_mut()[lane] = row.inverse_diagonal;
        }
    }
}

impl<P: Pack> TwistFactors<P, PerLane<P>> {
    /// Takes over the profile of one lane. Its rows are yet to be computed.
    pub fn set_profile(&mut self, lane: usize, profile: &RibbonProfile) {
        for (packs, pair) in self.inverse_masses.iter_mut().zip(&profile.inverse_areas) {
            for (pack, &inverse_area) in packs.iter_mut().zip(pair) {
                pack.set_lane(lane, inverse_area);
            }
        }
    }
}

/// Factorises the system of a profile, given the compliance of a cell of unit weight, 1/m⁴. In double
/// precision, as it is done once for many substeps.
pub(crate) fn factorise(profile: &RibbonProfile, compliance: f32) -> Vec<TwistRow<f32>> {
    let pairs: Vec<f64> =
        profile.inverse_areas.iter().map(|[a, b]| f64::from(*a) + f64::from(*b)).collect();
    let mut last = 0.0;
    let row = |(ends, coefficient): (&[f64], &f32)| {
        let softness =
            if *coefficient > 0.0 { f64::from(compliance / coefficient) } else { f64::INFINITY };
        let lower = -ends[0] * last;
        last = 1.0 / (ends[0] + ends[1] + softness + lower * ends[0]);
        TwistRow { lower: lower as f32, inverse_diagonal: last as f32 }
    };
    pairs.windows(2).zip(&profile.coefficients).map(row).collect()
}

/// The rows of a profile whose moments are zero.
pub(crate) fn without_twist(profile: &RibbonProfile) -> Vec<TwistRow<f32>> {
    let cells = profile.inverse_areas.len().saturating_sub(1);
    vec![TwistRow { lower: 0.0, inverse_diagonal: 0.0 }; cells]
}
