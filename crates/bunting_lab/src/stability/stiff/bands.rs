//! Bands between two clamps or poles, of materials stiff to stretch and to bend, and overdrawn ones.

use std::{
    f32::consts::{FRAC_PI_2, PI},
    sync::Arc,
};

use bunting_solver::{ClothSnapshot, Drive, Fabric, FabricBuilder, FabricMaterial, Grid};
use glam::{Vec2, Vec3};

use super::rests::rests;
use crate::{
    flight::almost_at_rest,
    stability::{case::HardCase, lone::Lone},
};

/// Particles along and across a band of a metre, and its width, m.
const BAND: ([u32; 2], f32) = ([65, 17], 0.1);
/// Damping of bands without weight and air, 1/s.
const DAMPING: f32 = 3.0;
/// Time after which a band rests, s, and a sheet between poles.
const SETTLED: [f64; 2] = [10.0, 15.0];
/// Particles along each side of a sheet between poles.
const SHEET: u32 = 33;

/// Leather of 1 mm, card of .3 mm and film of .2 mm.
const LEATHER: FabricMaterial = stiff(5e4, 4.2e-3, 0.9);
const CARD: FabricMaterial = stiff(9e5, 6.7e-3, 0.25);
const FILM: FabricMaterial = stiff(4e5, 1.3e-3, 0.28);

/// An isotropic material of a stiffness (N/m), a bending stiffness (N·m) and an area density (kg/m²).
const fn stiff(stretch: f32, bending: f32, density: f32) -> FabricMaterial {
    FabricMaterial {
        area_density: density,
        warp_stiffness: stretch,
        weft_stiffness: stretch,
        shear_stiffness: stretch / 2.6,
        bend_stiffness: bending,
        damping: DAMPING,
        ..FabricMaterial::FLAG_POLYESTER
    }
}

pub(super) fn cases() -> impl Iterator<Item = HardCase> {
    let bands = [
        ("leather twisted by 90°", LEATHER, twisted as fn(f32, Vec3) -> Vec3),
        ("leather bent to a U", LEATHER, to_a_u),
        ("card twisted by 90°", CARD, twisted),
        ("film twisted by 90°", FILM, twisted),
    ];
    let bands = bands.into_iter().map(|(name, material, pose)| band(name, material, pose));
    let sheets = [("90°, 15 % too long", FRAC_PI_2, 0.85), ("180°, 30 % too long", PI, 0.7)];
    bands.chain(sheets.into_iter().map(|(name, turn, span)| between_poles(name, turn, span)))
}

/// A band clamped at both ends by a cell, in a pose given the part of its length between the clamps.
fn band(name: &str, material: FabricMaterial, pose: fn(f32, Vec3) -> Vec3) -> HardCase {
    let ([columns, rows], width) = BAND;
    let cell = 1.0 / (columns - 1) as f32;
    let is_clamped = move |at: Vec3| at.x < 1.01 * cell || at.x > 1.0 - 1.01 * cell;
    let fabric = grid([columns, rows], width, is_clamped);
    let mut start = almost_at_rest(&fabric);
    for at in &mut start.positions {
        *at = pose(((at.x - cell) / (1.0 - 2.0 * cell)).clamp(0.0, 1.0), *at);
    }
    let mut band = Lone::new(&fabric, &start, material, Drive::NONE);
    rests(name, columns as usize, band.late_speed(SETTLED[0]))
}

/// A band one of whose ends is turned about its middle line.
fn twisted(part: f32, at: Vec3) -> Vec3 {
    let middle = Vec3::Y * (-0.5 * BAND.1);
    let across = Vec2::from_angle(FRAC_PI_2 * part).rotate(Vec2::new(at.y - middle.y, at.z));
    Vec3::new(at.x, middle.y + across.x, across.y)
}

/// A band whose ends are moved together by 30 %.
fn to_a_u(part: f32, at: Vec3) -> Vec3 {
    Vec3::new(0.5 + 0.7 * (at.x - 0.5), at.y, at.z + 0.32 * (PI * part).sin())
}

/// Polyester between two poles that are turned to one another, at `span` of its length.
fn between_poles(name: &str, turn: f32, span: f32) -> HardCase {
    let fabric = grid([SHEET; 2], 1.0, |at| at.x < 1e-6 || at.x > 0.9999);
    let mut start: ClothSnapshot = almost_at_rest(&fabric);
    let slack = 0.3 * (1.0 - span * span).sqrt();
    for at in &mut start.positions {
        let across = Vec2::from_angle(turn * (at.x - 0.5)) * (at.y + 0.5);
        let is_free = at.x > 1e-6 && at.x < 0.9999;
        let belly = if is_free { slack * (PI * at.x).sin() } else { 0.0 };
        *at = Vec3::new(0.5 + span * (at.x - 0.5), across.x - 0.5, across.y + at.z + belly);
    }
    let material = FabricMaterial { damping: 1.0, ..FabricMaterial::FLAG_POLYESTER };
    let mut sheet = Lone::new(&fabric, &start, material, Drive::default());
    let name = format!("polyester between poles turned by {name}");
    rests(name, SHEET as usize, sheet.late_speed(SETTLED[1]))
}

/// A grid of a metre by a height, m.
fn grid([columns, rows]: [u32; 2], height: f32, is_held: impl Fn(Vec3) -> bool) -> Arc<Fabric> {
    let grid = FabricBuilder::grid(Grid::new(columns, rows, 1.0, height));
    Arc::new(grid.pin_where(|at, _| is_held(at)).build().expect("a good grid"))
}
