//! A flag in gusts of 10 m/s.

use bunting_solver::{Drive, FabricMaterial};
use glam::Vec3;

use super::{
    super::{
        rig::{GRAVITY, Trial, hoisted, turning_wind},
        row::Row,
    },
    layers::LAYERS,
    watch::Watch,
};
use crate::product::TICK;

/// Row of the part of ticks in which the flag intersects itself.
pub(super) fn row(quick: bool) -> Row {
    let (watch, us) = flown(Some(LAYERS), if quick { 10.0 } else { 30.0 });
    watch.row_of_ticks("flag of 33² in gusts of 10 m/s", us)
}

/// Flies the flag for some seconds; returns the mean time of a tick, too, µs.
fn flown(layers: Option<f32>, seconds: f32) -> (Watch, f64) {
    let (fabric, start) = hoisted();
    let material = FabricMaterial::FLAG_POLYESTER;
    let mut cloth = Trial::from(&fabric, &start, material, -GRAVITY * Vec3::Y);
    cloth.keep_layers_apart(layers);
    let mut watch = Watch::default();
    for tick in 0..(seconds / TICK) as usize {
        let drive =
            Drive { wind: turning_wind(tick as f32 * TICK, [0.6, 0.4]), ..Drive::default() };
        cloth.drive(drive);
        cloth.tick();
        watch.note(&cloth);
    }
    (watch, cloth.us())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn passes_through_itself_unless_its_layers_are_kept_apart() {
        assert!(flown(None, 2.0).0.most > 0);
    }
}
