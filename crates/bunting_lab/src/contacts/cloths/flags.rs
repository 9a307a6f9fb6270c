//! Two flags on neighbouring poles in gusts, each of which reaches the other.

use bunting_solver::{Drive, FabricMaterial};
use glam::Vec3;

use super::{
    super::{
        rig::{hoisted, turning_wind},
        row::Row,
    },
    together::Together,
};
use crate::product::TICK;

/// Row of the part of ticks in which triangles intersect.
pub(super) fn row(quick: bool) -> Row {
    /// Greatest part of ticks.
    const PART: f64 = 1e-3;
    let flags = flown(true, if quick { 5.0 } else { 30.0 });
    Row::new(
        "two flags of 33² on poles 0.5 m apart in gusts of 10 m/s: ticks",
        "part of ticks with intersections, of one",
        flags.part(),
        PART,
        flags.us(),
    )
}

/// Flies the flags for some seconds.
fn flown(apart: bool, seconds: f32) -> Together {
    let mut flags = Together::new(apart);
    for index in 0..2 {
        let (fabric, start) = hoisted();
        // The second pole stands beside the first, so that the wind blows each flag against the other by turns.
        let at = index as f32 * Vec3::new(0.1, 0.02, 0.49);
        flags.add(&fabric, &start, FabricMaterial::FLAG_POLYESTER, at, []);
    }
    for tick in 0..(seconds / TICK) as usize {
        // It turns across the line between the poles.
        let wind = turning_wind(tick as f32 * TICK, [1.2, 0.6]);
        flags.tick(Drive { wind, ..Drive::default() });
    }
    flags
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flags_pass_through_one_another_unless_they_are_kept_apart() {
        assert!(flown(false, 3.0).most > 0);
    }
}
