//! Closed and half-closed shells.

use core::f32::consts::{FRAC_PI_2, FRAC_PI_4, TAU};

use bunting_solver::FabricBuilder;
use glam::Vec3;

/// Triangles in which the four corners of a cell are wound so that they are seen from outside, given the cell's and the
/// shell's middle.
fn outwards(positions: &[Vec3], indices: &mut Vec<u32>, cell: [u32; 4], middle: Vec3) {
    let [a, b, c, d] = cell;
    for triangle in [[a, b, c], [a, c, d]] {
        let [p, q, r] = triangle.map(|at| positions[at as usize]);
        let is_outwards = (q - p).cross(r - p).dot(p - middle) > 0.0;
        let [a, b, c] = triangle;
        indices.extend(if is_outwards { [a, b, c] } else { [a, c, b] });
    }
}

/// A sphere of a radius, m, of six sides of n × n cells.
pub fn sphere(n: u32, radius: f32) -> FabricBuilder {
    let (mut positions, mut indices) = (Vec::new(), Vec::new());
    for [out, along, across] in [[0, 1, 2], [1, 2, 0], [2, 0, 1]] {
        let axis =
            |at: usize| Vec3::from_array(core::array::from_fn(|i| if i == at { 1.0 } else { 0.0 }));
        for side in [1.0, -1.0] {
            let first = positions.len() as u32;
            let angle = |at: u32| libm::tanf((at as f32 / n as f32 * 2.0 - 1.0) * FRAC_PI_4);
            for (row, column) in (0..=n).flat_map(|row| (0..=n).map(move |column| (row, column))) {
                let at = axis(out) * side + axis(along) * angle(column) + axis(across) * angle(row);
                positions.push(at.normalize() * radius);
            }
            for (row, column) in (0..n).flat_map(|row| (0..n).map(move |column| (row, column))) {
                let at = first + row * (n + 1) + column;
                let cell = [at, at + 1, at + n + 2, at + n + 1];
                outwards(&positions, &mut indices, cell, Vec3::ZERO);
            }
        }
    }
    FabricBuilder::new(positions, indices).weld_distance(1e-5)
}

/// The upper half of a sphere of a radius, m, held at its rim.
pub fn hemisphere(rings: u32, around: u32, radius: f32) -> FabricBuilder {
    let mut positions = vec![Vec3::Y * radius];
    for ring in 1..=rings {
        let (out, up) = libm::sincosf(ring as f32 / rings as f32 * FRAC_PI_2);
        positions.extend((0..around).map(|at| {
            let (sin, cos) = libm::sincosf(at as f32 / around as f32 * TAU);
            radius * Vec3::new(out * cos, up, out * sin)
        }));
    }
    let at = |ring: u32, at: u32| 1 + (ring - 1) * around + at % around;
    let mut indices = Vec::new();
    for i in 0..around {
        indices.extend([0, at(1, i + 1), at(1, i)]);
        for ring in 1..rings {
            let cell = [at(ring, i), at(ring, i + 1), at(ring + 1, i + 1), at(ring + 1, i)];
            outwards(&positions, &mut indices, cell, Vec3::ZERO);
        }
    }
    FabricBuilder::new(positions, indices).pin_where(move |at, _| at.y < 1e-4 * radius)
}

/// A tube of a radius and a length along y, m, held at both ends.
pub fn tube(around: u32, radius: f32, rows: u32, length: f32) -> FabricBuilder {
    let held = move |at: Vec3, _| at.y <= 0.0 || at.y >= length;
    free_tube(around, radius, rows, length).pin_where(held)
}

/// A tube of a radius and a length along y from y = 0 on, m, that nothing holds. Its vertices are in rings from its beginning to its end.
pub fn free_tube(around: u32, radius: f32, rows: u32, length: f32) -> FabricBuilder {
    let mut positions = Vec::new();
    for row in 0..=rows {
        positions.extend((0..around).map(|at| {
            let (sin, cos) = libm::sincosf(at as f32 / around as f32 * TAU);
            Vec3::new(radius * cos, row as f32 / rows as f32 * length, radius * sin)
        }));
    }
    let at = |row: u32, at: u32| row * around + at % around;
    let mut indices = Vec::new();
    for (row, i) in (0..rows).flat_map(|row| (0..around).map(move |i| (row, i))) {
        let cell = [at(row, i), at(row, i + 1), at(row + 1, i + 1), at(row + 1, i)];
        outwards(
            &positions,
            &mut indices,
            cell,
            Vec3::Y * (length * (row as f32 + 0.5) / rows as f32),
        );
    }
    FabricBuilder::new(positions, indices)
}

/// The volume inside a closed shell, m³.
pub fn volume(triangles: &[[u32; 3]], positions: &[Vec3]) -> f32 {
    let of = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|at| positions[at as usize]);
        a.dot(b.cross(c)) / 6.0
    };
    triangles.iter().map(of).sum()
}
