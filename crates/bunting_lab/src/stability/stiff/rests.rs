//! What rests.

use crate::stability::case::HardCase;

/// Greatest speed of cloth at rest, m/s RMS. Motion is visible from 10 mm/s on.
const AT_REST: f64 = 1e-3;

/// Case of the greatest RMS speed in the last second of a run.
pub(super) fn rests(name: impl Into<String>, n: usize, speed: f64) -> HardCase {
    HardCase::new(format!("{}: at rest", name.into()), n, "RMS speed, m/s", speed, AT_REST)
}
