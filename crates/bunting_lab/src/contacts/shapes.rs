//! Shapes that the rows share: meshes, and dense samples of surfaces.

use glam::{Vec2, Vec3};
use parry3d::shape::SharedShape;

/// Height of the wavy sheet above a point, m.
pub(super) fn wave(at: Vec2) -> f32 {
    0.03 * (12.0 * at.x).sin() * (9.0 * at.y).cos()
}

/// An open mesh of triangles with legs of `leg` m: a wavy square around the origin with the given half side, m.
pub(super) fn wavy_mesh(half: f32, leg: f32) -> SharedShape {
    let cells = (2.0 * half / leg).round() as u32;
    let side = cells + 1;
    let at = |index: u32| -half + 2.0 * half * index as f32 / cells as f32;
    let corners = (0..side * side).map(|vertex| {
        let flat = Vec2::new(at(vertex % side), at(vertex / side));
        flat.extend(wave(flat))
    });
    let cell = |cell: u32| {
        let [a, b] = [0, side].map(|row| cell / cells * side + cell % cells + row);
        [[a, a + 1, b + 1], [a, b + 1, b]]
    };
    let triangles = (0..cells * cells).flat_map(cell).collect();
    SharedShape::trimesh(corners.collect(), triangles).expect("a good mesh")
}

/// Rings and sectors of the blob.
const RINGS: u32 = 9;
const SECTORS: u32 = 14;

/// Point of the blob's surface in a direction given by angles from the pole and about it, m.
fn blob_point(ring: u32, sector: u32) -> Vec3 {
    use std::f32::consts::{PI, TAU};
    let (down, about) =
        (PI * ring as f32 / RINGS as f32, TAU * (sector % SECTORS) as f32 / SECTORS as f32);
    let bumps = 1.0 + 0.25 * (3.0 * about).sin() * (2.0 * down).sin();
    0.2 * bumps * Vec3::new(down.sin() * about.cos(), down.sin() * about.sin(), down.cos())
}

/// A closed mesh of 224 triangles, like a ball of 20 cm with bumps.
pub(super) fn blob() -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let mut corners = vec![blob_point(0, 0)];
    for ring in 1..RINGS {
        corners.extend((0..SECTORS).map(|sector| blob_point(ring, sector)));
    }
    corners.push(blob_point(RINGS, 0));
    let last = corners.len() as u32 - 1;
    let at = |ring: u32, sector: u32| match ring {
        0 => 0,
        RINGS => last,
        _ => 1 + (ring - 1) * SECTORS + sector % SECTORS,
    };
    let mut triangles = Vec::new();
    for (ring, sector) in (0..RINGS).flat_map(|ring| (0..SECTORS).map(move |at| (ring, at))) {
        let [a, b] = [at(ring, sector), at(ring, sector + 1)];
        let [c, d] = [at(ring + 1, sector), at(ring + 1, sector + 1)];
        if ring > 0 {
            triangles.push([a, c, b]);
        }
        if ring + 1 < RINGS {
            triangles.push([b, c, d]);
        }
    }
    (corners, triangles)
}

/// Points on triangles, with a distance of about `spacing` m between neighbours.
pub(super) fn samples(corners: &[Vec3], triangles: &[[u32; 3]], spacing: f32) -> Vec<Vec3> {
    let of_triangle = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|corner| corners[corner as usize]);
        let longest = (b - a).length().max((c - b).length()).max((a - c).length());
        let parts = (longest / spacing).ceil().max(1.0) as u32;
        lattice(parts).into_iter().map(move |[u, v, w]| u * a + v * b + w * c)
    };
    triangles.iter().flat_map(of_triangle).collect()
}

/// Barycentric coordinates of a regular lattice of a triangle whose sides have so many parts.
pub(super) fn lattice(parts: u32) -> Vec<[f32; 3]> {
    let rows = (0..=parts).flat_map(|u| (0..=parts - u).map(move |v| [u, v, parts - u - v]));
    rows.map(|weights| weights.map(|weight| weight as f32 / parts as f32)).collect()
}
