//! A small sheet on a turntable: it slips from ω² r = μ g on.
//!
//! The turntable comes up to its rate slowly. The integrator's first substep is of first order and leaves a sheet that
//! begins at the full rate with a radial velocity of a h/2, which friction near its limit takes long to stop.

use bunting_solver::Collider;
use glam::{Quat, Vec3};

use super::{
    rig::{GRAVITY, Trial, cotton, floor, sheet, threshold},
    row::Row,
};
use crate::product::TICK;

/// Distance of the sheet's middle from the axis, m.
const RADIUS: f32 = 0.5;
/// Side of the sheet, m.
const SIDE: f32 = 0.1;
/// Distance over which a sheet counts as slipping, m.
const SLIPPED: f32 = 5e-3;

pub(super) fn rows(quick: bool) -> Vec<Row> {
    let frictions = if quick { &[0.5][..] } else { &[0.2, 0.5] };
    frictions.iter().map(|&friction| slip(friction)).collect()
}

/// Row of the rate from which on the sheet slips.
fn slip(friction: f32) -> Row {
    let (ratio, us) =
        threshold(0.8, 1.2, |ratio| slips(friction, (ratio * friction * GRAVITY / RADIUS).sqrt()));
    Row::new(
        format!("slip on a turntable, μ = {friction}"),
        "error of ω² r/μg, of one",
        (ratio - 1.0).abs().into(),
        0.02,
        us,
    )
}

/// Whether the sheet slips at a rate, rad/s, and the time of a tick, µs.
fn slips(friction: f32, rate: f32) -> (bool, f64) {
    /// Part of the rate with which the turntable begins.
    const BEGIN: f32 = 0.7;
    /// Ticks in which it comes up to the rate, and ticks over which the sheet must not slip.
    const STARTING: u32 = 90;
    const HOLDING: u32 = 60;
    let middle = Vec3::new(0.5 * SIDE, -0.5 * SIDE, 0.0);
    let axis = middle - RADIUS * Vec3::X;
    let velocity = |at: Vec3| BEGIN * rate * Vec3::Z.cross(at - axis);
    let gravity = -GRAVITY * Vec3::Z;
    let fabric = sheet(5, 5, SIDE, SIDE);
    let mut sheet = Trial::moving(&fabric, cotton(friction), gravity, velocity);
    let turned = |tick: u32| {
        let starting = tick.min(STARTING) as f32;
        let ticks = BEGIN * starting
            + 0.5 * (1.0 - BEGIN) * starting * starting / STARTING as f32
            + (tick - tick.min(STARTING)) as f32;
        Quat::from_rotation_z(rate * TICK * ticks)
    };
    let mut before = Vec3::ZERO;
    let mut farthest = 0.0_f32;
    for tick in 0..STARTING + HOLDING {
        let table = floor(friction);
        let at = Vec3::new(axis.x, axis.y, table.from.0.z);
        let (from, to) = ((at, turned(tick)), (at, turned(tick + 1)));
        sheet.touch([Collider { from, to, ..table }]);
        sheet.tick();
        // In the frame of the turntable.
        let now = turned(tick + 1).inverse() * (sheet.centre() - axis);
        if tick < STARTING {
            before = now;
        }
        farthest = farthest.max((now - before).truncate().length());
    }
    (farthest > SLIPPED, sheet.us())
}
