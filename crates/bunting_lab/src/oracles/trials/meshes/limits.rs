//! Limits of the cases.

use crate::oracles::Case;

/// Speed at rest, m/s RMS, and distance from the grid, m, that pass.
pub(super) const REST: [f64; 2] = [1e-3, 5e-3];

/// A measured size that must not exceed a limit.
pub(super) fn bound(name: String, limit: f64, measured: f64) -> Case {
    let relative_error = measured / limit;
    let pass = relative_error <= 1.0;
    Case { name, expected: limit, measured, relative_error, tolerance: 1.0, pass }
}
