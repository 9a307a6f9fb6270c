//! Positions of nodes on a curved mesh from fits of polynomials.
//!
//! A node in a triangle of a curved mesh lies below the surface, one on an edge less so: rows of such nodes zigzag, and
//! their links straighten under load. The value at a node of a quartic that is fitted to the particles around it lies
//! on the surface up to fifth order, that of a quadratic, where there are few particles, up to third order.

use glam::{DVec2, DVec3, Vec2};

use super::LEAST_FREE;
use super::chart::Chart;
use super::interpolation::{Interpolation, Term};
use crate::fabric::grid::Grid;

/// Radius around a node within which places count, in cells, or as much larger as vertices are farther apart. Smaller: too few for
/// a quartic. Larger: rows around a cylinder of sixteen cells zigzag, and the folds of a few cells are smoothed.
pub(in crate::fabric) const RADIUS: f64 = 2.8;

/// Least pivot of a fit's normal equations, relative to their largest element. Smaller: fits to places on few lines.
const LEAST_PIVOT: f64 = 1e-6;

/// Greatest sum of the magnitudes of a row's weights. Larger: a node moves by more than the particles around it.
pub(in crate::fabric) const GREATEST_SUM: f32 = 3.0;

/// The same of a node that stands for pins. Larger: beyond the last pin of a rim a node is extrapolated, and edges there are strained.
/// Smaller: nodes between pins lie on the chords between these.
const GREATEST_SUM_OF_PINS: f32 = 1.5;

/// Greatest distance of a place from the line that others lie on, in units of the radius. Larger: places on a curved border count as
/// on a line. Smaller: so does no border.
const OFF_LINE: f64 = 0.05;

/// Numbers of the coefficients of a quartic, of a quadratic and of a plane.
const QUARTIC: usize = 15;
pub(super) const QUADRATIC: usize = 6;
pub(super) const PLANE: usize = 3;

/// Rows of nodes by fits to the places around them, to pinned ones alone of nodes that stand for pins; the given rows where there
/// are too few places.
pub(super) fn smoothed(
    rows: Interpolation,
    chart: &Chart,
    grid: &Grid,
    is_free: &[bool],
    is_near_pins: &[bool],
) -> Interpolation {
    let places = PlacesInCells::new(&chart.positions, grid);
    let [width, height] = grid.spacing();
    let coarseness = chart.coarseness((width * height).sqrt());
    let mut smoothed = Interpolation::default();
    for (node, row) in rows.rows().enumerate() {
        let coarse: f32 = row.iter().map(|term| term.weight * coarseness[term.from as usize]).sum();
        let mut near = places.around(node as u32, RADIUS * f64::from(coarse).max(1.0));
        let free = row.iter().filter(|term| is_free[term.from as usize]);
        let is_free_enough = free.map(|term| term.weight).sum::<f32>() > LEAST_FREE;
        let stands_for_pins = is_near_pins[node] && !is_free_enough;
        if stands_for_pins {
            near.retain(|(place, _)| !is_free[*place as usize]);
        }
        let greatest = if stands_for_pins { GREATEST_SUM_OF_PINS } else { GREATEST_SUM };
        let smooth = |terms: &Vec<Term>| sum_of_magnitudes(terms) < greatest;
        let along = || fit_along(&near).filter(|terms| stands_for_pins && smooth(terms));
        match fit_smooth(&near, greatest).or_else(along) {
            Some(terms) => smoothed.push(terms),
            None => smoothed.push(row.iter().copied()),
        }
    }
    smoothed
}

/// Places in the plane by the cells that they lie in.
pub(super) struct PlacesInCells<'a> {
    positions: &'a [Vec2],
    grid: &'a Grid,
    in_cell: Vec<Vec<u32>>,
}

impl<'a> PlacesInCells<'a> {
    pub fn new(positions: &'a [Vec2], grid: &'a Grid) -> Self {
        let spacing = Vec2::from(grid.spacing());
        let mut in_cell = vec![Vec::new(); (grid.columns * grid.rows) as usize];
        for (place, at) in (0_u32..).zip(positions) {
            let cell = (*at / spacing).floor().max(Vec2::ZERO);
            let column = (cell.x as u32).min(grid.columns - 1);
            in_cell[grid.index(column, (cell.y as u32).min(grid.rows - 1)) as usize].push(place);
        }
        Self { positions, grid, in_cell }
    }

    /// The places within a radius around a node, in cells, relative to the node in units of the radius. The third
    /// coordinate is a weight, which falls to zero at the radius.
    pub fn around(&self, node: u32, radius: f64) -> Vec<(u32, DVec3)> {
        let Self { positions, grid, in_cell } = self;
        let spacing = Vec2::from(grid.spacing());
        let reach = radius.ceil() as u32;
        let (column, line) = (node % grid.columns, node / grid.columns);
        let at = Vec2::new(column as f32, line as f32);
        let columns = column.saturating_sub(reach)..(column + reach).min(grid.columns);
        let lines = line.saturating_sub(reach)..(line + reach).min(grid.rows);
        let cells = lines.flat_map(|line| columns.clone().map(move |column| (column, line)));
        let places = cells.flat_map(|(column, line)| &in_cell[grid.index(column, line) as usize]);
        let weighted = places.filter_map(|&place| {
            let away = (positions[place as usize] / spacing - at).as_dvec2() / radius;
            let nearness = 1.0 - away.length_squared();
            (nearness > 0.0).then(|| (place, away.extend(nearness * nearness)))
        });
        weighted.collect()
    }
}

/// [`fit`] of a quartic, or of a quadratic, whose weights have a sum of magnitudes below the greatest; none if neither has.
pub(in crate::fabric) fn fit_smooth(near: &[(u32, DVec3)], greatest: f32) -> Option<Vec<Term>> {
    let smooth = |terms: &Vec<Term>| sum_of_magnitudes(terms) < greatest;
    let quadratic = || fit::<QUADRATIC>(near).filter(smooth);
    fit::<QUARTIC>(near).filter(smooth).or_else(quadratic)
}

/// Weights of the values at places, given relative to the node with a weight as third coordinate, in the value at the
/// node of the polynomial that is fitted to them; none if they do not determine it.
pub(super) fn fit<const TERMS: usize>(near: &[(u32, DVec3)]) -> Option<Vec<Term>> {
    fit_powers(near, powers::<TERMS>)
}

/// The same of a sum of given powers of the coordinates, the first of which is one.
fn fit_powers<const TERMS: usize>(
    near: &[(u32, DVec3)],
    powers: fn(&DVec3) -> [f64; TERMS],
) -> Option<Vec<Term>> {
    let mut system = [[0.0; TERMS]; TERMS];
    for (_, at) in near {
        let powers = powers(at);
        for (row, one) in system.iter_mut().zip(powers) {
            for (element, other) in row.iter_mut().zip(powers) {
                *element += at.z * one * other;
            }
        }
    }
    // The value at the node is the first coefficient: the weights are those of the first row of the inverse.
    let mut solution = [0.0; TERMS];
    solution[0] = 1.0;
    let least = LEAST_PIVOT * system[0][0];
    for pivot in 0..TERMS {
        if system[pivot][pivot] <= least {
            return None;
        }
        let (row, value) = (system[pivot], solution[pivot]);
        for (index, other) in system.iter_mut().enumerate() {
            if index != pivot {
                let factor = other[pivot] / row[pivot];
                for (element, of_pivot) in other[pivot..].iter_mut().zip(&row[pivot..]) {
                    *element -= factor * of_pivot;
                }
                solution[index] -= factor * value;
            }
        }
    }
    for (index, value) in solution.iter_mut().enumerate() {
        *value /= system[index][index];
    }
    let weight = |at: &DVec3| {
        let powers = powers(at).into_iter();
        (at.z * powers.zip(solution).map(|(power, factor)| power * factor).sum::<f64>()) as f32
    };
    Some(near.iter().map(|(place, at)| Term { from: *place, weight: weight(at) }).collect())
}

/// The same of the quartic or the parabola along the line on which places lie, as those of a pinned border do; none unless the node
/// lies on it, too.
fn fit_along(near: &[(u32, DVec3)]) -> Option<Vec<Term>> {
    let mean = near.iter().map(|(_, at)| at.truncate()).sum::<DVec2>() / near.len() as f64;
    let aways = near.iter().map(|(_, at)| at.truncate() - mean);
    // At twice the angle of the principal axis. The half of it follows without functions of angles, whose bits differ from
    // machine to machine.
    let twice = aways.map(|away| away.rotate(away)).sum::<DVec2>();
    let length = twice.length();
    let axis = match twice.x > 0.0 {
        true => DVec2::new(length + twice.x, twice.y),
        false => DVec2::new(twice.y, length - twice.x),
    };
    let axis = axis.normalize_or_zero();
    let is_on = |away: DVec2| axis.perp_dot(away - mean).abs() < OFF_LINE;
    if !is_on(DVec2::ZERO) || !near.iter().all(|(_, at)| is_on(at.truncate())) {
        return None;
    }
    let place =
        |(place, at): &(u32, DVec3)| (*place, DVec3::new(axis.dot(at.truncate()), 0.0, at.z));
    let on_line: Vec<(u32, DVec3)> = near.iter().map(place).collect();
    fit_powers(&on_line, powers_along::<5>).or_else(|| fit_powers(&on_line, powers_along::<3>))
}

/// Sum of the magnitudes of a row's weights.
pub(super) fn sum_of_magnitudes(terms: &[Term]) -> f32 {
    terms.iter().map(|term| term.weight.abs()).sum()
}

/// The first powers of the first coordinate.
fn powers_along<const TERMS: usize>(at: &DVec3) -> [f64; TERMS] {
    let mut next = 1.0;
    core::array::from_fn(|_| {
        let power = next;
        next *= at.x;
        power
    })
}

/// The first products of powers of two coordinates, those of lower degree first.
fn powers<const TERMS: usize>(at: &DVec3) -> [f64; TERMS] {
    let (x, y) = (at.x, at.y);
    let [xx, xy, yy] = [x * x, x * y, y * y];
    let all: [f64; QUARTIC] = [
        1.0,
        x,
        y,
        xx,
        xy,
        yy,
        xx * x,
        xx * y,
        x * yy,
        yy * y,
        xx * xx,
        xx * xy,
        xx * yy,
        xy * yy,
        yy * yy,
    ];
    core::array::from_fn(|term| all[term])
}
