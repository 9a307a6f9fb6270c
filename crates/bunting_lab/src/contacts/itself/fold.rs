//! A sheet that is dropped on its edge, and folds in three on the floor.

use std::f32::consts::PI;

use bunting_solver::{ClothSnapshot, Collider};
use glam::{Quat, Vec3};
use parry3d::shape::SharedShape;

use super::{
    super::{
        rig::{GRAVITY, Trial, cotton, sheet},
        row::Row,
    },
    layers::LAYERS,
    watch::Watch,
};
use crate::product::TICK;

/// Rows of the most intersecting pairs in a tick, and of those at rest.
pub(super) fn rows() -> Vec<Row> {
    /// Most pairs in a tick.
    const MOST: f64 = 2.0;
    let (watch, us) = dropped(Some(LAYERS), 4.0);
    let name = "sheet of 33² dropped on its edge";
    vec![
        Row::new(format!("{name}: a tick"), "intersecting pairs", watch.most as f64, MOST, us),
        Row::new(format!("{name}: at rest"), "intersecting pairs", watch.last as f64, 0.0, us),
    ]
}

/// Drops the sheet, and watches it for some seconds; returns the mean time of a tick, too, µs.
fn dropped(layers: Option<f32>, seconds: f32) -> (Watch, f64) {
    /// Height of the lower edge above the floor, m.
    const HEIGHT: f32 = 0.02;
    /// Height of the waves in which the sheet begins to fold, m.
    const WAVE: f32 = 0.01;
    let fabric = sheet(33, 33, 1.0, 1.0);
    let mut start = ClothSnapshot::at_rest(&fabric);
    for at in &mut start.positions {
        at.z += WAVE * (3.0 * PI * at.y).sin() + 0.1 * WAVE * (2.0 * PI * at.x).sin();
    }
    let mut cloth = Trial::from(&fabric, &start, cotton(0.4), -GRAVITY * Vec3::Y);
    cloth.keep_layers_apart(layers);
    let floor = SharedShape::halfspace(Vec3::Y);
    cloth.touch([Collider::fixed(floor, (-1.0 - HEIGHT) * Vec3::Y, Quat::IDENTITY)]);
    let mut watch = Watch::default();
    for _ in 0..(seconds / TICK) as usize {
        cloth.tick();
        watch.note(&cloth);
    }
    (watch, cloth.us())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sheet_passes_through_itself_unless_its_layers_are_kept_apart() {
        assert!(dropped(None, 1.0).0.most > 100);
    }
}
