//! Meshes of rings of quads.

use std::f32::consts::{PI, TAU};

use bunting_solver::FabricBuilder;
use glam::Vec3;

/// Radius of bowls and balls, and of the circle that tori and Möbius strips go around, m.
const RADIUS: f32 = 0.3;

/// A mesh of `rings` rings of `columns` quads, given the place of a ring, from 0 to 1, and an azimuth, rad.
pub(crate) fn around(columns: u32, rings: u32, at: impl Fn(f32, f32) -> Vec3) -> FabricBuilder {
    closed(columns, rings, false, at)
}

/// The same; where it is twisted, the first ring goes on as the last.
fn closed(
    columns: u32,
    rings: u32,
    is_twisted: bool,
    at: impl Fn(f32, f32) -> Vec3,
) -> FabricBuilder {
    let vertex =
        |ring, column| at(ring as f32 / rings as f32, TAU * column as f32 / columns as f32);
    let vertices = (0..=rings).flat_map(|ring| (0..columns).map(move |column| (ring, column)));
    let positions = vertices.map(|(ring, column)| vertex(ring, column)).collect();
    let index = |ring: u32, column: u32| match column {
        last if last == columns && is_twisted => (rings - ring) * columns,
        column => ring * columns + column % columns,
    };
    let quads = (0..rings).flat_map(|ring| (0..columns).map(move |column| (ring, column)));
    let triangles = quads.flat_map(|(ring, column)| {
        let corner = |down: u32, right: u32| index(ring + down, column + right);
        let [a, b, c, d] = [corner(0, 0), corner(0, 1), corner(1, 0), corner(1, 1)];
        [a, b, c, c, b, d]
    });
    FabricBuilder::new(positions, triangles.collect())
}

/// The part of a sphere between two angles (rad) from its axis, of which a ring is given from 0 to 1, and an azimuth, rad.
pub(crate) fn sphere([first, last]: [f32; 2]) -> impl Fn(f32, f32) -> Vec3 {
    move |ring, azimuth| {
        let polar = first + (last - first) * ring;
        let outwards =
            Vec3::new(polar.sin() * azimuth.cos(), polar.cos(), polar.sin() * azimuth.sin());
        RADIUS * outwards
    }
}

/// A strip of a width, m, of `rings` rings of `columns` quads that has made half a turn when it has gone around.
pub(crate) fn moebius(columns: u32, rings: u32, width: f32) -> FabricBuilder {
    closed(columns, rings, true, |across, azimuth| {
        let aside = width * (across - 0.5);
        let away = RADIUS + aside * (0.5 * azimuth).cos();
        Vec3::new(away * azimuth.cos(), aside * (0.5 * azimuth).sin(), away * azimuth.sin())
    })
}

/// A torus of `rings` rings of `columns` quads, whose tube has a radius, m.
pub(crate) fn torus(columns: u32, rings: u32, of_tube: f32) -> FabricBuilder {
    let mesh = around(columns, rings, |ring, azimuth| {
        let (sin, cos) = (TAU * ring).sin_cos();
        let away = RADIUS + of_tube * cos;
        Vec3::new(away * azimuth.cos(), of_tube * sin, away * azimuth.sin())
    });
    mesh.weld_distance(1e-5)
}

/// A ball of a radius, m, of `rings` rings of `columns` quads, of which the first and the last are fans of triangles around
/// the poles. The same on every machine.
pub(crate) fn ball_with_poles(columns: u32, rings: u32, radius: f32) -> FabricBuilder {
    let place = |ring: u32, at: u32| {
        let (out, up) = libm::sincosf(PI * ring as f32 / rings as f32);
        let (sin, cos) = libm::sincosf(TAU * at as f32 / columns as f32);
        Vec3::new(out * cos, up, -out * sin) * radius
    };
    let inner = (1..rings).flat_map(|ring| (0..columns).map(move |at| place(ring, at)));
    let positions = inner.chain([place(0, 0), place(rings, 0)]).collect();
    let [top, bottom] = [0, 1].map(|pole| (rings - 1) * columns + pole);
    let vertex = |ring: u32, at: u32| (ring - 1) * columns + at % columns;
    let mut indices = Vec::new();
    for at in 0..columns {
        indices.extend([top, vertex(1, at), vertex(1, at + 1)]);
        for ring in 1..rings - 1 {
            let [a, b] = [vertex(ring, at), vertex(ring, at + 1)];
            let [c, d] = [vertex(ring + 1, at), vertex(ring + 1, at + 1)];
            indices.extend([a, c, b, b, c, d]);
        }
        indices.extend([bottom, vertex(rings - 1, at + 1), vertex(rings - 1, at)]);
    }
    FabricBuilder::new(positions, indices)
}
