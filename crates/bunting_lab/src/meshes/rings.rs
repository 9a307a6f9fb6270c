//! Meshes of rings of quads.

use std::f32::consts::TAU;

use bunting_solver::FabricBuilder;
use glam::Vec3;

/// A mesh of `rings` rings of `columns` quads, given the place of a ring, from 0 to 1, and an azimuth, rad. Where it is
/// twisted, the first ring goes on as the last.
pub(crate) fn around(
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
