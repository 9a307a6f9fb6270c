//! Positions of nodes on a curved mesh from quadratic fits.
//!
//! A node in a triangle of a curved mesh lies below the surface, one on an edge less so: rows of such nodes zigzag, and
//! their links straighten under load. The value at a node of a quadratic that is fitted to the particles around it lies
//! on the surface up to third order.

use glam::{DVec3, Vec2};

use super::interpolation::{Interpolation, Term};
use crate::fabric::grid::Grid;

/// Radius around a node within which places count, in cells. Smaller: too few for a quadratic. Larger: folds of a few
/// cells are smoothed.
const RADIUS: f64 = 2.2;

/// Least pivot of a fit's normal equations, relative to their largest element. Smaller: fits to places on few lines.
const LEAST_PIVOT: f64 = 1e-4;

/// Greatest sum of the magnitudes of a row's weights. Larger: a node moves by more than the particles around it.
const GREATEST_SUM: f32 = 3.0;

/// Number of a quadratic's coefficients.
const TERMS: usize = 6;

/// Rows of nodes by quadratic fits to the places around them; the given rows where there are too few places, and of nodes
/// in triangles with a corner that is not free, as a node between pins stays between them.
pub(super) fn smoothed(
    rows: Interpolation,
    positions: &[Vec2],
    grid: &Grid,
    is_free: &[bool],
) -> Interpolation {
    let spacing = Vec2::from(grid.spacing());
    let mut in_cell = vec![Vec::new(); (grid.columns * grid.rows) as usize];
    for (place, at) in (0_u32..).zip(positions) {
        let cell = (*at / spacing).floor().max(Vec2::ZERO);
        let column = (cell.x as u32).min(grid.columns - 1);
        in_cell[grid.index(column, (cell.y as u32).min(grid.rows - 1)) as usize].push(place);
    }
    let reach = RADIUS.ceil() as u32;
    let mut smoothed = Interpolation::default();
    for (node, row) in rows.rows().enumerate() {
        let (column, line) = (node as u32 % grid.columns, node as u32 / grid.columns);
        let at = Vec2::new(column as f32, line as f32);
        let columns = column.saturating_sub(reach)..(column + reach).min(grid.columns);
        let lines = line.saturating_sub(reach)..(line + reach).min(grid.rows);
        let cells = lines.flat_map(|line| columns.clone().map(move |column| (column, line)));
        let near: Vec<(u32, DVec3)> = cells
            .flat_map(|(column, line)| &in_cell[grid.index(column, line) as usize])
            .filter_map(|&place| {
                let away = (positions[place as usize] / spacing - at).as_dvec2() / RADIUS;
                let nearness = 1.0 - away.length_squared();
                (nearness > 0.0).then(|| (place, away.extend(nearness * nearness)))
            })
            .collect();
        let is_smooth = !row.is_empty() && row.iter().all(|term| is_free[term.from as usize]);
        match fit(&near).filter(|_| is_smooth) {
            Some(terms) => smoothed.push(terms),
            None => smoothed.push(row.iter().copied()),
        }
    }
    smoothed
}

/// Weights of the values at places, given relative to the node with a weight as third coordinate, in the value at the
/// node of the quadratic that is fitted to them; none if they do not determine it.
fn fit(near: &[(u32, DVec3)]) -> Option<Vec<Term>> {
    let powers = |at: &DVec3| [1.0, at.x, at.y, at.x * at.x, at.x * at.y, at.y * at.y];
    let mut system = [[0.0; TERMS + 1]; TERMS];
    for (_, at) in near {
        let powers = powers(at);
        for (row, one) in system.iter_mut().zip(powers) {
            for (element, other) in row.iter_mut().zip(powers) {
                *element += at.z * one * other;
            }
        }
    }
    // The value at the node is the first coefficient: the weights are those of the first row of the inverse.
    system[0][TERMS] = 1.0;
    let scale = system[0][0];
    for pivot in 0..TERMS {
        if system[pivot][pivot] <= LEAST_PIVOT * scale {
            return None;
        }
        let row = system[pivot];
        for (index, other) in system.iter_mut().enumerate() {
            if index != pivot {
                let factor = other[pivot] / row[pivot];
                for (element, of_pivot) in other.iter_mut().zip(row) {
                    *element -= factor * of_pivot;
                }
            }
        }
    }
    let mut solution = [0.0; TERMS];
    for (index, row) in system.iter().enumerate() {
        solution[index] = row[TERMS] / row[index];
    }
    let weight = |at: &DVec3| {
        let sum: f64 = powers(at).iter().zip(solution).map(|(power, factor)| power * factor).sum();
        (at.z * sum) as f32
    };
    let terms: Vec<Term> =
        near.iter().map(|(place, at)| Term { from: *place, weight: weight(at) }).collect();
    let sum: f32 = terms.iter().map(|term| term.weight.abs()).sum();
    (sum < GREATEST_SUM).then_some(terms)
}
