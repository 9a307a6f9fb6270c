//! An irregular mesh.

use std::sync::Arc;

use bunting_solver::{Fabric, FabricBuilder, Resolution};
use glam::{Vec2, Vec3};

/// Numbers from 0 to 1, one after the other (xorshift, Marsaglia 2003).
struct Noise(u32);

impl Noise {
    fn next(&mut self) -> f32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        (self.0 >> 8) as f32 / (1 << 24) as f32
    }
}

/// A square metre of `n` × `n` vertices, moved by up to a fifth of a cell, in cells that are cut either way, hung from
/// its top. The warp runs at an angle to the top, rad.
pub fn irregular(n: u32, angle: f32) -> FabricBuilder {
    let mut noise = Noise(7);
    let spacing = 1.0 / (n - 1) as f32;
    let inner = |index: u32| index > 0 && index < n - 1;
    let mut positions = Vec::new();
    for (row, column) in (0..n).flat_map(|row| (0..n).map(move |column| (row, column))) {
        let mut jitter = || (noise.next() - 0.5) * 0.4;
        let (dx, dy) = (jitter(), jitter());
        let moved = if inner(row) && inner(column) { Vec2::new(dx, dy) } else { Vec2::ZERO };
        let at = (Vec2::new(column as f32, row as f32) + moved) * spacing;
        positions.push(Vec3::new(at.x, -at.y, 0.0));
    }
    let mut indices = Vec::new();
    for (row, column) in (0..n - 1).flat_map(|row| (0..n - 1).map(move |column| (row, column))) {
        let corner = |right, down| (row + down) * n + column + right;
        let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(0, 1), corner(1, 1)];
        if noise.next() < 0.5 {
            indices.extend([a, c, d, a, d, b]);
        } else {
            indices.extend([a, c, b, b, c, d]);
        }
    }
    let (sin, cos) = (libm::sinf(angle), libm::cosf(angle));
    let turned = |at: &Vec3| Vec2::new(cos * at.x - sin * at.y, sin * at.x + cos * at.y);
    let uv = positions.iter().map(turned).collect();
    let builder = FabricBuilder::new(positions, indices).uv(uv);
    builder.pin_where(|at, _| at.y == 0.0)
}

/// A mesh simulated with about as many particles as it has vertices.
pub fn net(mesh: &FabricBuilder) -> Arc<Fabric> {
    let resolution = Resolution::Particles(mesh.particle_count() as u32);
    mesh.resampled(resolution).expect("a good mesh").fabric
}
