//! Three sheets that are dropped on one another on a floor.

use bunting_solver::{ClothSnapshot, Collider, Drive};
use glam::{Quat, Vec3};
use parry3d::shape::SharedShape;

use super::{
    super::{
        rig::{GRAVITY, cotton, sheet},
        row::Row,
    },
    together::Together,
};
use crate::product::TICK;

/// Rows of the most intersecting pairs in a tick, and of those at rest.
pub(super) fn rows() -> Vec<Row> {
    /// Most pairs in a tick.
    const MOST: f64 = 2.0;
    let sheets = dropped(true, 5.0);
    let (most, last, us) = (sheets.most as f64, sheets.last as f64, sheets.us());
    let name = "three sheets of 33² dropped on one another";
    vec![
        Row::new(format!("{name}: a tick"), "intersecting pairs", most, MOST, us),
        Row::new(format!("{name}: at rest"), "intersecting pairs", last, 0.0, us),
    ]
}

/// Drops the sheets, each turned and at a height of its own, and watches them for some seconds.
fn dropped(apart: bool, seconds: f32) -> Together {
    /// Height of the lowest sheet above the floor, and distance of the sheets, m.
    const HEIGHT: f32 = 0.1;
    let fabric = sheet(33, 33, 1.0, 1.0);
    let mut sheets = Together::new(apart);
    for index in 0..3 {
        let turn = Quat::from_rotation_y(0.35 * index as f32);
        let tilt = Quat::from_rotation_x(0.1 * (index as f32 - 1.0));
        let mut start = ClothSnapshot::at_rest(&fabric);
        for at in &mut start.positions {
            let flat = Vec3::new(at.x - 0.5, 0.0, at.y + 0.5);
            *at = turn * (tilt * flat) + 0.05 * index as f32 * Vec3::X;
        }
        let at = HEIGHT * (index + 1) as f32 * Vec3::Y;
        let floor = Collider::fixed(SharedShape::halfspace(Vec3::Y), -at, Quat::IDENTITY);
        sheets.add(&fabric, &start, cotton(0.4), at, [floor]);
    }
    for _ in 0..(seconds / TICK) as usize {
        sheets.tick(Drive { gravity: -GRAVITY * Vec3::Y, ..Drive::NONE });
    }
    sheets
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sheets_pass_through_one_another_unless_they_are_kept_apart() {
        assert!(dropped(false, 1.0).most > 100);
    }
}
