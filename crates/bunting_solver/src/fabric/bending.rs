//! Bending of cloth that is flat at rest: second differences along the lines of a grid.
//!
//! The energy ½ B ∫ (|x_uu|² + |x_vv|²) with three-point stencils is quadratic, so the implicit step
//! of a whole line is a pentadiagonal system with constant factors. All lines whose particles weigh
//! and are pinned alike share one [`BendProfile`], and so one set of factors.

use super::Grid;
use super::colour::{Classes, rounded_bits};

/// A row or a column of a grid.
#[derive(Clone, Debug, PartialEq)]
pub struct BendLine {
    /// The particles along it.
    pub particles: Vec<u32>,
    /// Index into [`Fabric::bend_profiles`](super::Fabric::bend_profiles).
    pub profile: u32,
}

/// What lines of one kind have in common.
#[derive(Clone, Debug, PartialEq)]
pub struct BendProfile {
    /// One over the distance between neighbours at rest, 1/m.
    pub inverse_spacing: f32,
    /// One over the area of each particle, 1/m²; zero where it is pinned.
    pub inverse_areas: Vec<f32>,
    /// For each particle but the first and the last: stiffness against a unit change of direction
    /// there, in units of the material's bending stiffness.
    pub weights: Vec<f32>,
}

/// Where a line leaves pinned ground the stencil covers half a cell: twice the stiffness makes the
/// heavy cantilever converge at second order instead of first.
const CLAMP_WEIGHT: f32 = 2.0;

/// The rows, then the columns, of a grid.
pub(crate) fn lines(grid: &Grid, inverse_areas: &[f32]) -> (Vec<BendLine>, Vec<BendProfile>) {
    let (dx, dy) = (grid.width / (grid.columns - 1) as f32, grid.height / (grid.rows - 1) as f32);
    let border = |index: u32, count: u32| if index == 0 || index == count - 1 { 0.5 } else { 1.0 };
    let rows = (0..grid.rows).map(|row| {
        let particles = (0..grid.columns).map(|column| grid.index(column, row)).collect();
        (particles, dx, dy * border(row, grid.rows))
    });
    let columns = (0..grid.columns).map(|column| {
        let particles = (0..grid.rows).map(|row| grid.index(column, row)).collect();
        (particles, dy, dx * border(column, grid.columns))
    });
    let mut profiles: Vec<BendProfile> = Vec::new();
    let mut classes = Classes::new();
    let lines =
        rows.chain(columns).filter(|(particles, ..): &(Vec<u32>, f32, f32)| particles.len() > 2);
    let lines = lines.map(|(particles, spacing, width)| {
        let profile = BendProfile::new(&particles, spacing, width, inverse_areas);
        let (class, is_new) = classes.class_of(profile.bits());
        if is_new {
            profiles.push(profile);
        }
        BendLine { particles, profile: class }
    });
    (lines.collect(), profiles)
}

impl BendProfile {
    fn new(particles: &[u32], spacing: f32, width: f32, inverse_areas: &[f32]) -> Self {
        let inverse_areas: Vec<f32> =
            particles.iter().map(|&particle| inverse_areas[particle as usize]).collect();
        let weights = inverse_areas
            .windows(3)
            .map(|three| {
                let at_clamp = three[1] == 0.0 && (three[0] == 0.0) != (three[2] == 0.0);
                width / spacing * if at_clamp { CLAMP_WEIGHT } else { 1.0 }
            })
            .collect();
        Self { inverse_spacing: 1.0 / spacing, inverse_areas, weights }
    }

    /// Equal for lines that are alike but for rounding.
    fn bits(&self) -> Vec<u32> {
        let all =
            core::iter::once(&self.inverse_spacing).chain(&self.inverse_areas).chain(&self.weights);
        all.map(|value| rounded_bits(*value)).collect()
    }
}
