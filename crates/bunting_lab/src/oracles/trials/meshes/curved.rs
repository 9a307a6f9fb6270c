//! A mesh that is curved at rest bends as its material does.

use std::f64::consts::FRAC_PI_2;

use bunting_solver::{Drive, FabricBuilder, FabricMaterial, Resampled};
use glam::{DVec2, Vec2, Vec3};

use super::cloth::Cloth;
use super::materials::ISOTROPIC;
use crate::{
    meshes::{Sheet, Triangulation, resampled},
    oracles::{Case, bending::quarter_arc},
};

/// Radius of the arc, m.
const RADIUS: f64 = 0.3;
/// Particles along the arc, and across it.
const PARTICLES: [usize; 2] = [33, 9];
/// σ g R³/B of the load. Larger: the arc's shape changes, which the closed form leaves out.
const LOAD: f64 = 0.02;
/// Error of the end's way that passes.
const ERROR: f64 = 0.05;

/// How far the end of a quarter arc that is clamped where it is level moves under a small load, m, level and down.
pub(super) fn cases(triangulation: Triangulation) -> [Case; 2] {
    let [along, across] = PARTICLES;
    let cell = RADIUS * FRAC_PI_2 / (along - 1) as f64;
    let size = DVec2::new(along as f64, (across - 1) as f64) * cell;
    let sheet = Sheet::new(triangulation, [along + 1, across], size, 2);
    let bend = |at: &Vec3| {
        let (sin, cos) = ((f64::from(at.x) - cell) / RADIUS).sin_cos();
        Vec3::new((RADIUS * sin) as f32, (RADIUS * (1.0 - cos)) as f32, at.y)
    };
    let is_clamped = |at: &Vec3| f64::from(at.x) < 1.001 * cell;
    let clamped = (0..).zip(&sheet.positions).filter(|(_, at)| is_clamped(at));
    let clamped: Vec<u32> = clamped.map(|(vertex, _)| vertex).collect();
    let uv = sheet.positions.iter().map(|at| Vec2::new(at.x, -at.y)).collect();
    let positions = sheet.positions.iter().map(bend).collect();
    let mesh = FabricBuilder::new(positions, sheet.indices.clone()).uv(uv).pin(clamped);
    let Resampled { fabric, carried, .. } = resampled(&mesh).expect("a cloth");
    let stiffness = 1e-2;
    let material = FabricMaterial { bend_stiffness: stiffness as f32, damping: 8.0, ..ISOTROPIC };
    let mut cloth = Cloth::new(fabric, material, |at| at);
    let mut end_under = |gravity: f64, seconds: f64| {
        let gravity = Vec3::NEG_Y * gravity as f32;
        cloth.drive(Drive { gravity, air_density: 0.0, ..Drive::default() });
        cloth.run(seconds);
        let shown = carried.positions(&cloth.positions);
        let end = sheet.positions.iter().zip(&shown);
        let end = end.filter(|(at, _)| f64::from(at.x) > size.x - 1e-5);
        let (sum, count) = end.fold((DVec2::ZERO, 0.0), |(sum, count), (_, at)| {
            (sum + at.as_dvec3().truncate(), count + 1.0)
        });
        sum / count
    };
    let gravity = LOAD * stiffness / (f64::from(material.area_density) * RADIUS.powi(3));
    let at_rest = end_under(0.0, 1.0);
    let moved = end_under(gravity, 20.0) - at_rest;
    let expected = quarter_arc(LOAD) * RADIUS;
    let case = |axis: &str, expected: f64, measured: f64| {
        let name = format!("quarter arc, clamped, {triangulation:?}, {axis}, m");
        Case::new(name, expected, measured, ERROR)
    };
    [case("level", expected.x, moved.x), case("down", expected.y, moved.y)]
}
