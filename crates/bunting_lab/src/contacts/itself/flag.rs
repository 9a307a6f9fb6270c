//! A flag in gusts of 10 m/s.

use std::{f32::consts::TAU, sync::Arc};

use bunting_solver::{ClothSnapshot, Drive, FabricBuilder, FabricMaterial, Grid};
use glam::Vec3;

use super::{
    super::{
        rig::{GRAVITY, Trial},
        row::Row,
    },
    LAYERS,
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
    let grid = FabricBuilder::grid(Grid::new(33, 33, 1.0, 1.0));
    let fabric = Arc::new(grid.pin_where(|_, uv| uv.x == 0.0).build().expect("a good grid"));
    let mut start = ClothSnapshot::at_rest(&fabric);
    for (particle, at) in start.positions.iter_mut().enumerate() {
        if !fabric.is_pinned(particle) {
            at.z += 1e-4 * ((particle * 7919 % 1000) as f32 / 1000.0 - 0.5);
        }
    }
    let material = FabricMaterial::FLAG_POLYESTER;
    let mut cloth = Trial::from(&fabric, &start, material, -GRAVITY * Vec3::Y);
    cloth.keep_layers_apart(layers);
    let mut watch = Watch::default();
    for tick in 0..(seconds / TICK) as usize {
        let drive = Drive { wind: wind(tick as f32 * TICK), ..Drive::default() };
        cloth.batch.drive(0, drive).expect("a good drive");
        cloth.tick();
        watch.note(&cloth);
    }
    (watch, cloth.us())
}

/// Wind of 10 m/s that turns and fades for moments, m/s.
fn wind(time: f32) -> Vec3 {
    let wave = |frequency: f32| (TAU * frequency * time).sin();
    let strength = 10.0 * (0.6 + 0.4 * wave(0.37));
    let angle = 0.6 * wave(0.23) + 0.4 * wave(0.61);
    strength * Vec3::new(angle.cos(), 0.15 * wave(0.83), angle.sin())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn passes_through_itself_unless_its_layers_are_kept_apart() {
        assert!(flown(None, 2.0).0.most > 0);
    }
}
