//! Sheets that swing from their top edge.

use std::f64::consts::PI;

use faer::{Mat, Side};

/// Zeros of the Bessel function J₀.
const BESSEL_ZEROS: [f64; 3] = [2.404825557695773, 5.520078110286311, 8.653727912911013];

/// Angular frequencies of the first three modes of a limp hanging sheet, rad/s: (j₀ₙ/2)√(g/L).
#[must_use]
pub fn hanging_modes(gravity: f64, length: f64) -> [f64; 3] {
    BESSEL_ZEROS.map(|zero| 0.5 * zero * (gravity / length).sqrt())
}

/// A mode of small swings of a hanging chain.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// Angular frequency over √(g/L).
    pub rate: f64,
    /// Displacement of each mass, from the top.
    pub shape: Vec<f64>,
}

/// Modes of a hanging chain of equal segments with these masses, the slowest first.
///
/// # Panics
///
/// When a mass is not positive.
#[must_use]
pub fn modes_of_chain(masses: &[f64]) -> Vec<Mode> {
    let count = masses.len();
    // Segment k hangs above mass k. Its stiffness is its tension over its length, L/count.
    let tension = |segment: usize| masses[segment..].iter().sum::<f64>();
    let stiffness = |row: usize, column: usize| match row.abs_diff(column) {
        0 => tension(row) + tension(row + 1),
        1 => -tension(row.max(column)),
        _ => 0.0,
    };
    let matrix = Mat::from_fn(count, count, |row, column| {
        stiffness(row, column) / (masses[row] * masses[column]).sqrt() * count as f64
    });
    let modes = matrix.self_adjoint_eigen(Side::Lower).expect("a finite symmetric matrix");
    let shape = |mode: usize| {
        masses.iter().enumerate().map(|(row, mass)| modes.U()[(row, mode)] / mass.sqrt()).collect()
    };
    (0..count).map(|mode| Mode { rate: modes.S()[mode].sqrt(), shape: shape(mode) }).collect()
}

/// Angular frequencies over √(g/L) of a hanging chain of `segments` segments, ascending. The last mass is
/// `tip` times each of the others.
#[must_use]
pub fn chain_modes(segments: usize, tip: f64) -> Vec<f64> {
    let masses: Vec<f64> =
        (1..=segments).map(|row| if row == segments { tip } else { 1.0 }).collect();
    modes_of_chain(&masses).into_iter().map(|mode| mode.rate).collect()
}

/// Period in seconds of small swings of a stiff sheet of `segments` rows of lumped mass; None for the
/// continuum: 2π√(L_eq/g), L_eq = L(2/3 + 1/(3N²)).
#[must_use]
pub fn stiff_period(gravity: f64, length: f64, segments: Option<usize>) -> f64 {
    let lumping = segments.map_or(0.0, |n| 1.0 / (3.0 * (n * n) as f64));
    2.0 * PI * (length * (2.0 / 3.0 + lumping) / gravity).sqrt()
}

/// Factor on the period at an amplitude θ (rad): (2/π) K(sin(θ/2)) = 1/agm(1, cos(θ/2)).
#[must_use]
pub fn amplitude_factor(amplitude: f64) -> f64 {
    let (mut a, mut b) = (1.0, (0.5 * amplitude).cos());
    while a - b > f64::EPSILON * a {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    1.0 / a
}
