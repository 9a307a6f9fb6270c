//! Twist of a grid, which is flat at rest: ribbons of cells between neighbouring rows or columns.
//!
//! The energy B ∫ |x_uv|², with x_uv = (x₀₀ − x₁₀ − x₀₁ + x₁₁)/(Δx Δy) in each cell, is the part of a sheet's bending
//! energy that rows and columns leave out. Neighbouring cells of a ribbon share two particles, so that the implicit
//! step of a whole ribbon is a tridiagonal system with constant factors.

use super::classes::{Classes, rounded_bits};
use super::grid::Grid;
use super::regions::Variation;

/// The cells between two neighbouring lines of a grid.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Ribbon {
    /// Particles of the two lines that lie opposite to one another, from one end to the other.
    pub pairs: Vec<[u32; 2]>,
    /// Index into [`Twist::profiles`].
    pub profile: u32,
}

/// Values that ribbons of one kind share.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RibbonProfile {
    /// Stiffness of each cell in units of the material's bending stiffness, 1/m²; zero where there is no cloth.
    pub coefficients: Vec<f32>,
    /// One over the area of each particle, 1/m²; zero if it is pinned.
    pub inverse_areas: Vec<[f32; 2]>,
}

/// The ribbons along which a grid twists; none for other meshes.
#[derive(Clone, Debug, Default)]
pub(crate) struct Twist {
    /// Every second ribbon and then the others, so that neighbours in the list share no particle.
    pub ribbons: Vec<Ribbon>,
    /// Profiles that ribbons refer to.
    pub profiles: Vec<RibbonProfile>,
}

impl Twist {
    /// The ribbons along a grid's longer side, where twist accumulates over most cells.
    pub fn of(grid: &Grid, inverse_areas: &[f32], variation: &Variation) -> Self {
        let along_columns = grid.rows >= grid.columns;
        let (across, along) =
            if along_columns { (grid.columns, grid.rows) } else { (grid.rows, grid.columns) };
        let particle = |line: u32, place: u32| {
            if along_columns { grid.index(line, place) } else { grid.index(place, line) }
        };
        let inverse_area = |particle: u32| inverse_areas[particle as usize];
        let [dx, _] = grid.spacing();
        let cell_area = dx * grid.height / (grid.rows - 1) as f32;
        let coefficient =
            |[a, b]: [u32; 2], [c, d]: [u32; 2]| 2.0 / cell_area * variation.of_twist([a, b, c, d]);
        let mut profiles: Vec<RibbonProfile> = Vec::new();
        let mut classes = Classes::new();
        let ribbon = |line: u32| {
            let pair = |place: u32| [particle(line, place), particle(line + 1, place)];
            let pairs: Vec<[u32; 2]> = (0..along).map(pair).collect();
            let profile = RibbonProfile {
                coefficients: pairs.windows(2).map(|ends| coefficient(ends[0], ends[1])).collect(),
                inverse_areas: pairs.iter().map(|pair| pair.map(inverse_area)).collect(),
            };
            let (class, is_new) = classes.class_of(profile.key());
            if is_new {
                profiles.push(profile);
            }
            Ribbon { pairs, profile: class }
        };
        let lines = (0..across - 1).step_by(2).chain((1..across - 1).step_by(2));
        let ribbons = lines.map(ribbon).collect();
        Self { ribbons, profiles }
    }
}

impl RibbonProfile {
    /// Key that is equal for profiles that differ by rounding only.
    fn key(&self) -> Vec<u32> {
        let areas = self.inverse_areas.as_flattened().iter();
        self.coefficients.iter().chain(areas).map(|&value| rounded_bits(value)).collect()
    }
}
