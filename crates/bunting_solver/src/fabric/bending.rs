//! Bending of a grid: second differences along its rows and columns.
//!
//! The energy ½ B ∫ (|x_uu|² + |x_vv|²) with three-point stencils is quadratic in the positions, so that the
//! implicit step of a whole line is a pentadiagonal system with constant factors. Lines with the same spacing,
//! areas and pins share one [`BendProfile`], and so one set of factors.

use super::cell_sizes::CellSizes;
use super::clamp::CLAMP_FACTOR;
use super::classes::{Classes, rounded_bits};
use super::grid::Grid;

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
    /// The same at the ends of a closed line, which are at one place.
    pub closing: Option<f32>,
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
    /// Rows and columns of three and more particles. The columns of a closed grid end where they begin.
    /// Particles are evenly far apart unless sizes are given.
    pub fn of(
        grid: &Grid,
        inverse_areas: &[f32],
        is_closed: bool,
        sizes: Option<&CellSizes>,
    ) -> Self {
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
            let closes = is_closed && !is_row;
            let size = |particle: u32| match sizes {
                Some(CellSizes { spacings, widths, .. }) => {
                    let line = usize::from(!is_row);
                    (spacings[particle as usize][line], widths[particle as usize][line])
                }
                None => (spacing, width),
            };
            let sizes: Vec<(f32, f32)> = particles.iter().map(|&particle| size(particle)).collect();
            let profile = BendProfile::new(&particles, &sizes, inverse_areas, closes);
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
        is_closed: bool,
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
        let before_last = inverse_areas[inverse_areas.len() - 2];
        let inner = inverse_areas.windows(3).zip(&sizes[1..]);
        let coefficients =
            inner.map(|(three, &size)| coefficient([three[0], three[1], three[2]], size));
        Self {
            inverse_spacing: 1.0 / spacing,
            coefficients: coefficients.collect(),
            closing: is_closed
                .then(|| coefficient([before_last, inverse_areas[0], inverse_areas[1]], sizes[0])),
            inverse_areas,
        }
    }

    /// Key that is equal for profiles that differ by rounding only.
    fn key(&self) -> Vec<u32> {
        let areas_and_coefficients = self.inverse_areas.iter().chain(&self.coefficients);
        let closing = self.closing.iter().chain(areas_and_coefficients);
        let values = core::iter::once(&self.inverse_spacing).chain(closing);
        values.map(|value| rounded_bits(*value)).collect()
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::Bending;
    use crate::fabric::cell_sizes::CellSizes;
    use crate::fabric::grid::Grid;

    #[test]
    fn lines_that_are_unevenly_far_apart_store_the_energy_of_a_cylinder() {
        const CURVATURE: f32 = 2.0;
        let grid = Grid::new(41, 9, 1.0, 0.5);
        // From 0.02 m to 0.03 m between columns.
        let graded = |at: Vec3| Vec3::new(at.x * (0.8 + 0.2 * at.x), at.y, 0.0);
        let rest: Vec<Vec3> = grid.positions().into_iter().map(graded).collect();
        let sizes = CellSizes::of(&grid, &rest, false, &vec![1.0; grid.cells().count()]);
        let bending = Bending::of(&grid, &vec![1.0; rest.len()], false, Some(&sizes));
        let height = |at: Vec3| 0.5 * CURVATURE * at.x * at.x;
        let (mut energy, mut area) = (0.0, 0.0);
        for line in bending.lines.iter().filter(|line| line.is_row) {
            let profile = &bending.profiles[line.profile as usize];
            for (three, coefficient) in line.particles.windows(3).zip(&profile.coefficients) {
                let [a, b, c] = [0, 1, 2].map(|at| rest[three[at] as usize]);
                // The second difference at rest turns with the cloth by the slope.
                let at_rest = CURVATURE * b.x * (a.x - 2.0 * b.x + c.x);
                let turn = height(a) - 2.0 * height(b) + height(c) - at_rest;
                let turn = turn * profile.inverse_spacing;
                energy += 0.5 * coefficient * turn * turn;
                let middle = three[1] as usize;
                area += sizes.spacings[middle][0] * sizes.widths[middle][0];
            }
        }
        let expected = 0.5 * CURVATURE * CURVATURE * area;
        assert!((energy / expected - 1.0).abs() < 0.01, "{energy} of {expected}");
    }
}
