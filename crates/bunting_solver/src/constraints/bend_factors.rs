//! The factorised systems of bend lines.
//!
//! With one row of D a particle's stencil (1, −2, 1)/l, W the inverse masses and α̃ the compliances over the
//! rows' weights, the XPBD system of a line is the pentadiagonal D W Dᵀ + α̃. It is constant over many
//! substeps and factorised as L D Lᵀ, L having ones on its diagonal and two bands below it.
//!
//! A closed line has two more constraints, which couple its ends: the bend there, and that both are at one place. The
//! line is solved without them first. What each particle then moves for a unit violation of either is constant, too: with
//! E their rows and G = W − W Dᵀ (D W Dᵀ + α̃)⁻¹ D W what a force moves on a line that is solved, it is
//! G Eᵀ (E G Eᵀ + α̃)⁻¹ (Woodbury's formula).

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
    /// Displacement of each particle of a closed line by a unit violation of the bend at its ends, and of their distance;
    /// empty for open lines.
    pub closing: Vec<[P; 2]>,
}

/// The factors of the lines of a profile, of one cloth.
pub(crate) struct LineFactors {
    pub rows: Vec<BendRow<f32>>,
    /// As [`BendFactors::closing`].
    pub closing: Vec<[f32; 2]>,
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
        let closes = longest.is_some_and(|profile| profile.closing.is_some());
        Self {
            closing: vec![[zero; 2]; if closes { particles } else { 0 }],
            rows: vec![row; longest.map_or(0, |profile| profile.coefficients.len())],
            mobilities: (0..particles)
                .map(|particle| C::of(|lane| mobility(lane, particle)))
                .collect(),
        }
    }

    /// Overwrites the rows of one lane.
    pub fn set_lane(&mut self, lane: usize, factors: &LineFactors) {
        let closing = self.closing.as_flattened_mut().iter_mut();
        for (pack, &moved) in closing.zip(factors.closing.as_flattened()) {
            pack.lanes_mut()[lane] = moved;
        }
        for (packs, row) in self.rows.iter_mut().zip(&factors.rows) {
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
pub(crate) fn factorise(profile: &BendProfile, compliance: f32) -> LineFactors {
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
    let rows: Vec<BendRow<f64>> = profile.coefficients.iter().enumerate().map(row).collect();
    let closing =
        profile.closing.map(|weight| closing(&mobilities, &rows, softness(compliance, weight)));
    let single = |row: &BendRow<f64>| BendRow {
        first_lower: row.first_lower as f32,
        second_lower: row.second_lower as f32,
        inverse_diagonal: row.inverse_diagonal as f32,
    };
    LineFactors { rows: rows.iter().map(single).collect(), closing: closing.unwrap_or_default() }
}

/// Compliance of a row of a weight, 1/m⁴; infinite where there is nothing that bends.
fn softness(compliance: f32, weight: f32) -> f64 {
    if weight > 0.0 { f64::from(compliance) / f64::from(weight) } else { f64::INFINITY }
}

/// Compliance of the distance between the ends of a closed line, in units of their mobility: against a division by zero
/// where both are pinned. Larger: the ends of a stiff line move apart.
const LEAST_SOFTNESS: f64 = 1e-6;

/// What a unit violation of the bend at the ends of a closed line, and of their distance, moves its particles by, given the
/// softness of the bend.
fn closing(mobilities: &[f64], rows: &[BendRow<f64>], softness: f64) -> Vec<[f32; 2]> {
    let count = mobilities.len();
    let greatest = mobilities.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let stencils = [
        [(0, -1.0), (1, 1.0), (count - 2, 1.0), (count - 1, -1.0)],
        [(0, 1.0), (1, 0.0), (count - 2, 0.0), (count - 1, -1.0)],
    ];
    let moved = stencils.map(|stencil| {
        let mut forces = vec![0.0; count];
        stencil.into_iter().for_each(|(at, force)| forces[at] += force);
        moved_on_line(mobilities, rows, &forces)
    });
    let product = |of: usize, by: usize| -> f64 {
        stencils[of].iter().map(|(at, weight)| weight * moved[by][*at]).sum()
    };
    let bend = product(0, 0) + softness;
    let distance = product(1, 1) + LEAST_SOFTNESS * greatest;
    let coupling = product(0, 1);
    let determinant = bend * distance - coupling * coupling;
    let [by_bend, by_distance] = &moved;
    if softness.is_infinite() {
        // There is no cloth that bends where the ends meet.
        let together = by_distance.iter().map(|by| [0.0, (by / distance) as f32]);
        return together.collect();
    }
    let of_particle = |(by_bend, by_distance): (&f64, &f64)| {
        [
            ((by_bend * distance - by_distance * coupling) / determinant) as f32,
            ((by_distance * bend - by_bend * coupling) / determinant) as f32,
        ]
    };
    by_bend.iter().zip(by_distance).map(of_particle).collect()
}

/// G f: what forces move the particles of a line by that resists bending.
fn moved_on_line(mobilities: &[f64], rows: &[BendRow<f64>], forces: &[f64]) -> Vec<f64> {
    let mut moved: Vec<f64> = mobilities.iter().zip(forces).map(|(by, force)| by * force).collect();
    let mut moments: Vec<f64> = Vec::with_capacity(rows.len());
    for (at, row) in rows.iter().enumerate() {
        let bend = moved[at] - 2.0 * moved[at + 1] + moved[at + 2];
        let last = if at >= 1 { moments[at - 1] * row.first_lower } else { 0.0 };
        let before_last = if at >= 2 { moments[at - 2] * row.second_lower } else { 0.0 };
        moments.push(-bend - last - before_last);
    }
    for at in (0..rows.len()).rev() {
        let next = rows.get(at + 1).map_or(0.0, |row| row.first_lower * moments[at + 1]);
        let after_next = rows.get(at + 2).map_or(0.0, |row| row.second_lower * moments[at + 2]);
        moments[at] = moments[at] * rows[at].inverse_diagonal - next - after_next;
    }
    for (at, moment) in moments.iter().enumerate() {
        for (stencil, weight) in [1.0, -2.0, 1.0].into_iter().enumerate() {
            moved[at + stencil] += mobilities[at + stencil] * weight * moment;
        }
    }
    moved
}
