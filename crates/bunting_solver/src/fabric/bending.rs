//! Bending of a grid: second differences along its rows and columns.
//!
//! The energy ½ B ∫ (|x_uu|² + |x_vv|²) with three-point stencils is quadratic in the positions, so that the
//! implicit step of a whole line is a pentadiagonal system with constant factors. Lines with the same spacing,
//! areas and pins share one [`BendProfile`], and so one set of factors.

use super::clamp::CLAMP_FACTOR;
use super::classes::{Classes, rounded_bits};
use super::grid::Grid;
use super::regions::Variation;

/// A row or a column of a grid.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct BendLine {
    /// Whether it is a row.
    pub is_row: bool,
    /// Particles along the line.
    pub particles: Vec<u32>,
    /// Index into [`Bending::profiles`].
    pub profile: u32,
}

/// Values that lines of one kind share.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct BendProfile {
    /// One over the distance between neighbours at rest, 1/m.
    pub inverse_spacing: f32,
    /// One over the area of each particle, 1/m²; zero if it is pinned.
    pub inverse_areas: Vec<f32>,
    /// For each particle but the first and the last: stiffness against a unit change of direction there, in units
    /// of the material's bending stiffness; zero where there is no cloth.
    pub coefficients: Vec<f32>,
}

/// The lines along which a grid bends; none for other meshes.
#[derive(Clone, Debug, Default)]
pub(crate) struct Bending {
    /// Rows, then columns.
    pub lines: Vec<BendLine>,
    /// Profiles that lines refer to.
    pub profiles: Vec<BendProfile>,
}

impl Bending {
    /// Rows and columns of three and more particles.
    pub fn of(grid: &Grid, inverse_areas: &[f32], variation: &Variation) -> Self {
        let [dx, dy] = grid.spacing();
        // The first and the last line represent half a cell.
        let cells =
            |index: u32, count: u32| if index == 0 || index == count - 1 { 0.5 } else { 1.0 };
        let rows = (0..grid.rows).map(|row| {
            let particles = (0..grid.columns).map(|column| grid.index(column, row)).collect();
            (true, particles, dx, dy * cells(row, grid.rows))
        });
        let columns = (0..grid.columns).map(|column| {
            let particles = (0..grid.rows).map(|row| grid.index(column, row)).collect();
            (false, particles, dy, dx * cells(column, grid.columns))
        });
        let mut profiles: Vec<BendProfile> = Vec::new();
        let mut classes = Classes::new();
        let bends = |(_, particles, ..): &(bool, Vec<u32>, f32, f32)| particles.len() > 2;
        let lines = rows.chain(columns).filter(bends).map(|(is_row, particles, spacing, width)| {
            let sizes = vec![(spacing, width); particles.len()];
            let profile = BendProfile::new(&particles, &sizes, inverse_areas, variation);
            let (class, is_new) = classes.class_of(profile.key());
            if is_new {
                profiles.push(profile);
            }
            BendLine { is_row, particles, profile: class }
        });
        Self { lines: lines.collect(), profiles }
    }
}

impl BendProfile {
    /// A line of particles. `sizes` are their distances, m, and the widths of cloth that the line represents there, m.
    pub(super) fn new(
        particles: &[u32],
        sizes: &[(f32, f32)],
        inverse_areas: &[f32],
        variation: &Variation,
    ) -> Self {
        // One spacing for the whole line, whose second differences the coefficients weigh by the real ones.
        let spacing = sizes[sizes.len() / 2].0;
        let inverse_areas: Vec<f32> =
            particles.iter().map(|&particle| inverse_areas[particle as usize]).collect();
        let coefficient = |three: [f32; 3], (distance, width): (f32, f32)| {
            let at_clamp = three[1] == 0.0 && (three[0] == 0.0) != (three[2] == 0.0);
            let ratio = spacing / distance;
            width / distance * (ratio * ratio) * if at_clamp { CLAMP_FACTOR } else { 1.0 }
        };
        let inner = inverse_areas.windows(3).zip(&sizes[1..]).zip(&particles[1..]);
        let coefficients = inner.map(|((three, &size), &particle)| {
            coefficient([three[0], three[1], three[2]], size) * variation.of_bend(particle)
        });
        Self { inverse_spacing: 1.0 / spacing, coefficients: coefficients.collect(), inverse_areas }
    }

    /// Key that is equal for profiles that differ by rounding only.
    fn key(&self) -> Vec<u32> {
        let areas_and_coefficients = self.inverse_areas.iter().chain(&self.coefficients);
        let values = core::iter::once(&self.inverse_spacing).chain(areas_and_coefficients);
        values.map(|value| rounded_bits(*value)).collect()
    }
}
