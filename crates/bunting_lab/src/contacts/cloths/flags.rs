//! Two flags on neighbouring poles in gusts, each of which reaches the other.

use std::{f32::consts::TAU, sync::Arc};

use bunting_solver::{ClothSnapshot, Drive, FabricBuilder, FabricMaterial, Grid};
use glam::Vec3;

use super::{super::row::Row, together::Together};
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
        let grid = FabricBuilder::grid(Grid::new(33, 33, 1.0, 1.0));
        let fabric = Arc::new(grid.pin_where(|_, uv| uv.x == 0.0).build().expect("a good grid"));
        let mut start = ClothSnapshot::at_rest(&fabric);
        for (particle, at) in start.positions.iter_mut().enumerate() {
            if !fabric.is_pinned(particle) {
                at.z += 1e-4 * ((particle * 7919 % 1000) as f32 / 1000.0 - 0.5);
            }
        }
        // The second pole stands beside the first, so that the wind blows each flag against the other by turns.
        let at = index as f32 * Vec3::new(0.1, 0.02, 0.49);
        flags.add(&fabric, &start, FabricMaterial::FLAG_POLYESTER, at, []);
    }
    for tick in 0..(seconds / TICK) as usize {
        flags.tick(Drive { wind: wind(tick as f32 * TICK), ..Drive::default() });
    }
    flags
}

/// Wind of 10 m/s that turns across the line between the poles and fades for moments, m/s.
fn wind(time: f32) -> Vec3 {
    let wave = |frequency: f32| (TAU * frequency * time).sin();
    let strength = 10.0 * (0.6 + 0.4 * wave(0.37));
    let angle = 1.2 * wave(0.23) + 0.6 * wave(0.61);
    strength * Vec3::new(angle.cos(), 0.15 * wave(0.83), angle.sin())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flags_pass_through_one_another_unless_they_are_kept_apart() {
        assert!(flown(false, 3.0).most > 0);
    }
}
