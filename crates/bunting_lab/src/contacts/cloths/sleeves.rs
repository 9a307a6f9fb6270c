//! Two sleeves that begin in each other.

use core::f32::consts::TAU;
use std::sync::Arc;

use bunting_solver::{ClothSnapshot, Drive, Fabric, FabricBuilder, FabricMaterial};
use glam::{Quat, Vec3};

use super::{
    super::{rig::GRAVITY, row::Row},
    together::Together,
};
use crate::product::TICK;

/// Number of particles around a sleeve, and along it.
const AROUND: u32 = 20;
const ALONG: u32 = 17;

/// Radius and length of a sleeve, m.
const RADIUS: f32 = 0.08;
const LENGTH: f32 = 0.5;

/// Distance of the sleeves at their pins, m.
const GAP: f32 = 0.01;

/// Rows of sleeves that lean into each other by 1 and 3 cm.
pub(super) fn rows() -> Vec<Row> {
    [(1, 0.04), (3, 0.08)].into_iter().flat_map(|(deep, lean)| of_lean(deep, lean)).collect()
}

/// Rows of two sleeves, one of which leans by an angle, rad, and so is some centimetres in the other one.
fn of_lean(deep: u32, lean: f32) -> [Row; 2] {
    /// Greatest speed at rest, m/s.
    const SPEED: f64 = 5e-3;
    let mut sleeves = Together::new(true);
    for (at, lean) in [(0.0, 0.0), (2.0 * RADIUS + GAP, lean)] {
        let fabric = sleeve(lean);
        let start = ClothSnapshot::at_rest(&fabric);
        sleeves.add(&fabric, &start, FabricMaterial::COTTON, Vec3::X * at, []);
    }
    let mut wait = |seconds: f32| {
        for _ in 0..(seconds / TICK) as usize {
            sleeves.tick(Drive { gravity: -GRAVITY * Vec3::Y, ..Drive::default() });
        }
        sleeves.last as f64
    };
    let pairs = wait(3.0);
    wait(3.0);
    let (name, us) = (format!("sleeves that begin {deep} cm in each other"), sleeves.us());
    [
        Row::new(format!("{name}: after 3 s"), "intersecting pairs", pairs, 0.0, us),
        Row::new(format!("{name}: at rest"), "greatest speed, m/s", sleeves.speed(), SPEED, us),
    ]
}

/// A tube that hangs at its upper ring and leans by an angle, rad.
fn sleeve(lean: f32) -> Arc<Fabric> {
    let at = |particle: u32| {
        let turn = TAU * (particle % AROUND) as f32 / AROUND as f32;
        let down = LENGTH * (particle / AROUND) as f32 / (ALONG - 1) as f32;
        let straight = Vec3::new(RADIUS * turn.cos(), -down, RADIUS * turn.sin());
        Quat::from_rotation_z(-lean) * straight
    };
    let square = |square: u32| {
        let [a, b] = [square, square - square % AROUND + (square + 1) % AROUND];
        let [c, d] = [a + AROUND, b + AROUND];
        [a, b, c, b, d, c]
    };
    let positions = (0..AROUND * ALONG).map(at).collect();
    let indices = (0..AROUND * (ALONG - 1)).flat_map(square).collect();
    Arc::new(FabricBuilder::new(positions, indices).pin(0..AROUND).build().expect("a good mesh"))
}
