//! Twist of cloth that is flat at rest: ribbons of cells between neighbouring lines of a grid.
//!
//! The energy B ∫ |x_uv|², with x_uv = (x₀₀ − x₁₀ − x₀₁ + x₁₁)/(Δx Δy) in each cell, is what rows and columns
//! leave out of the bending of a sheet. Along a ribbon neighbouring cells share two particles, so that the
//! implicit step of a whole ribbon is a tridiagonal system with constant factors.

use super::Grid;
use super::colour::{Classes, rounded_bits};

/// The cells between two neighbouring lines of a grid.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Ribbon {
    /// The particles across it, from one end to the other.
    pub pairs: Vec<[u32; 2]>,
    /// Index into the profiles.
    pub profile: u32,
}

/// What ribbons of one kind have in common.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RibbonProfile {
    /// Stiffness of a cell in units of the material's bending stiffness, 1/m².
    pub weight: f32,
    /// One over the area of each particle, 1/m²; zero where it is pinned.
    pub inverse_areas: Vec<[f32; 2]>,
}

/// The ribbons along a grid's longer side, where twist adds up over most cells: every second, and then
/// the others.
pub(crate) fn ribbons(grid: &Grid, inverse_areas: &[f32]) -> (Vec<Ribbon>, Vec<RibbonProfile>) {
    let along_columns = grid.rows >= grid.columns;
    let (across, along) =
        if along_columns { (grid.columns, grid.rows) } else { (grid.rows, grid.columns) };
    let particle = |line: u32, place: u32| {
        if along_columns { grid.index(line, place) } else { grid.index(place, line) }
    };
    let cell = grid.width / (grid.columns - 1) as f32 * grid.height / (grid.rows - 1) as f32;
    let mut profiles: Vec<RibbonProfile> = Vec::new();
    let mut classes = Classes::new();
    let ribbon = |line: u32| {
        let pairs: Vec<[u32; 2]> =
            (0..along).map(|place| [particle(line, place), particle(line + 1, place)]).collect();
        let profile = RibbonProfile {
            weight: 2.0 / cell,
            inverse_areas: pairs
                .iter()
                .map(|pair| pair.map(|particle| inverse_areas[particle as usize]))
                .collect(),
        };
        let (class, is_new) = classes.class_of(profile.bits());
        if is_new {
            profiles.push(profile);
        }
        Ribbon { pairs, profile: class }
    };
    let lines = (0..across - 1).step_by(2).chain((1..across - 1).step_by(2));
    let ribbons = lines.map(ribbon).collect();
    (ribbons, profiles)
}

impl RibbonProfile {
    /// Equal for ribbons that are alike but for rounding.
    fn bits(&self) -> Vec<u32> {
        self.inverse_areas.as_flattened().iter().map(|&value| rounded_bits(value)).collect()
    }
}
