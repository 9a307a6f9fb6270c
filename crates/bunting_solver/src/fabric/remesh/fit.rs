//! Fits of polynomials to places around a node.
//!
//! A node in a triangle of a curved mesh lies below the surface, one on an edge less so: rows of such nodes zigzag, and
//! their links straighten under load. The value at a node of a quartic that is fitted to the particles around it lies
//! on the surface up to fifth order, that of a quadratic, where there are few particles, up to third order.

use glam::DVec3;

use crate::fabric::interpolation::Term;

/// Radius around a node within which places count, in cells, or as much larger as vertices are farther apart. Smaller: too few for
/// a quartic. Larger: rows around a cylinder of sixteen cells zigzag, and the folds of a few cells are smoothed.
pub(super) const RADIUS: f64 = 2.8;

/// Least pivot of a fit's normal equations, relative to their largest element. Smaller: fits to places on few lines.
const LEAST_PIVOT: f64 = 1e-6;

/// Greatest sum of the magnitudes of a row's weights. Larger: a node moves by more than the particles around it.
pub(super) const GREATEST_SUM: f32 = 3.0;

/// Numbers of the coefficients of a quartic and of a quadratic.
const QUARTIC: usize = 15;
const QUADRATIC: usize = 6;

/// [`fit`] of a quartic, or of a quadratic, whose weights have a sum of magnitudes below the greatest; none if neither has.
pub(super) fn fit_smooth(near: &[(u32, DVec3)], greatest: f32) -> Option<Vec<Term>> {
    let smooth = |terms: &Vec<Term>| sum_of_magnitudes(terms) < greatest;
    let quadratic = || fit::<QUADRATIC>(near).filter(smooth);
    fit::<QUARTIC>(near).filter(smooth).or_else(quadratic)
}

/// Weights of the values at places, given relative to the node with a weight as third coordinate, in the value at the
/// node of the polynomial that is fitted to them; none if they do not determine it.
fn fit<const TERMS: usize>(near: &[(u32, DVec3)]) -> Option<Vec<Term>> {
    // The normal equations are symmetric: their upper half is enough.
    let mut system = [[0.0; TERMS]; TERMS];
    for (_, at) in near {
        let powers = powers::<TERMS>(at);
        for (index, row) in system.iter_mut().enumerate() {
            let factor = at.z * powers[index];
            for (element, other) in row[index..].iter_mut().zip(&powers[index..]) {
                *element += factor * other;
            }
        }
    }
    // The value at the node is the first coefficient: the weights are those of the first row of the inverse.
    let mut solution = [0.0; TERMS];
    solution[0] = 1.0;
    let least = LEAST_PIVOT * system[0][0];
    for pivot in 0..TERMS {
        let row = system[pivot];
        if row[pivot] <= least {
            return None;
        }
        for index in pivot + 1..TERMS {
            let factor = row[index] / row[pivot];
            for (element, of_pivot) in system[index][index..].iter_mut().zip(&row[index..]) {
                *element -= factor * of_pivot;
            }
            solution[index] -= factor * solution[pivot];
        }
    }
    for index in (0..TERMS).rev() {
        let after = index + 1..;
        let known = system[index][after.clone()].iter().zip(&solution[after]);
        let sum: f64 = known.map(|(factor, value)| factor * value).sum();
        solution[index] = (solution[index] - sum) / system[index][index];
    }
    let weight = |at: &DVec3| {
        let powers = powers::<TERMS>(at).into_iter();
        (at.z * powers.zip(solution).map(|(power, factor)| power * factor).sum::<f64>()) as f32
    };
    Some(near.iter().map(|(place, at)| Term { from: *place, weight: weight(at) }).collect())
}

/// Sum of the magnitudes of a row's weights.
fn sum_of_magnitudes(terms: &[Term]) -> f32 {
    terms.iter().map(|term| term.weight.abs()).sum()
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
