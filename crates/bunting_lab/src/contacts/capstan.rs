//! The capstan: a strip over a cylinder slips from T₂/T₁ = exp(μ θ) on (Euler 1769).
//!
//! The law does not depend on the force. The solver does: what contacts push out in a substep, chains have pulled in
//! before, by (β h)² T/(ρ r) for a tension T per width, so that links on the cylinder are stretched by (β h)² T/(ρ r²).
//! Effort by need takes as many substeps as keep that strain slight where the cylinder presses most. At the great force it takes
//! too few for a quarter of a turn with little friction, where the strip slips too early: that row is known to fail.

use std::sync::Arc;

use bunting_solver::{ClothSnapshot, Collider, Fabric, FabricBuilder, FabricMaterial, Grid};
use glam::{Quat, Vec3};
use parry3d::shape::SharedShape;

use super::{
    rig::{THICKNESS, Trial, cotton, threshold},
    row::Row,
};

/// Radius of the cylinder, m.
const RADIUS: f32 = 0.1;
/// Columns and rows of the strip, along and across the pull.
const SIZE: [u32; 2] = [65, 5];
/// Length and width of the strip, m.
const LENGTH: f32 = 1.0;
const WIDTH: f32 = 0.1;
/// Forces at the end that pulls less, N. The strip weighs 0.12 N.
const SLIGHT: f32 = 0.02;
const MIDDLE: f32 = 0.1;
const GREAT: f32 = 1.0;
/// Ticks in which the forces grow to their size. Effort by need is that of the tick before, and a sudden force of the great size
/// would move an end by 0.15 m in its first tick.
const PULLING: u32 = 60;
/// Ticks after which the strip has settled, and ticks over which it must not slip. A strip that slips does so slowly:
/// each link that comes onto the cylinder has to be stretched first.
const SETTLING: usize = 120;
const HOLDING: usize = 120;
/// Distance over which a strip counts as slipping, m.
const SLIPPED: f32 = 5e-3;

pub(super) fn rows(quick: bool) -> Vec<Row> {
    let few = [
        (0.2, 90.0, SLIGHT),
        (0.5, 180.0, SLIGHT),
        (0.5, 90.0, MIDDLE),
        (0.5, 180.0, MIDDLE),
        (0.2, 90.0, GREAT),
        (0.5, 180.0, GREAT),
    ];
    let others = [
        (0.2, 180.0, SLIGHT),
        (0.5, 90.0, SLIGHT),
        (0.2, 90.0, MIDDLE),
        (0.2, 180.0, MIDDLE),
        (0.2, 180.0, GREAT),
        (0.5, 90.0, GREAT),
    ];
    let others = if quick { &[][..] } else { &others };
    let of = |&(friction, degrees, force): &(f32, f32, f32)| ratio(friction, degrees, force);
    few.iter().chain(others).map(of).collect()
}

/// Row of the ratio of forces from which on the strip slips.
fn ratio(friction: f32, degrees: f32, force: f32) -> Row {
    let exact = (friction * degrees.to_radians()).exp();
    let slips = |relative| slips(friction, degrees, [force, relative * exact * force]);
    let (relative, us) = threshold(0.7, 1.3, slips);
    Row::new(
        format!("capstan, μ = {friction}, θ = {degrees}°, {force} N"),
        "error of T₂/T₁, of one",
        (relative - 1.0).abs().into(),
        0.05,
        us,
    )
}

fn strip() -> Arc<Fabric> {
    let grid = Grid::new(SIZE[0], SIZE[1], LENGTH, WIDTH);
    Arc::new(FabricBuilder::grid(grid).build().expect("a good grid"))
}

/// Whether the strip slips under the forces at its ends, N, and the time of a tick, µs.
fn slips(friction: f32, degrees: f32, [less, more]: [f32; 2]) -> (bool, f64) {
    let fabric = strip();
    let angle = degrees.to_radians();
    let radius = RADIUS + THICKNESS;
    // The strip is wound around a cylinder along y, the middle of its length on top, its ends straight.
    let wind = |along: f32| {
        let half = 0.5 * angle;
        let turned = (along / radius).clamp(-half, half);
        let straight = along - turned * radius;
        let (sine, cosine) = turned.sin_cos();
        radius * Vec3::new(sine, 0.0, cosine) + straight * Vec3::new(cosine, 0.0, -sine)
    };
    let rest = fabric.rest_positions();
    let positions = rest.iter().map(|at| wind(at.x - 0.5 * LENGTH) + at.y * Vec3::Y).collect();
    let start = ClothSnapshot::new(positions, vec![Vec3::ZERO; rest.len()]);
    let material = FabricMaterial { bend_stiffness: 0.0, damping: 1.0, ..cotton(friction) };
    let mut strip = Trial::from(&fabric, &start, material, Vec3::ZERO);
    let upright = SharedShape::capsule_y(WIDTH, RADIUS);
    let middle = -0.5 * WIDTH * Vec3::Y;
    strip.touch([Collider { friction, ..Collider::fixed(upright, middle, Quat::IDENTITY) }]);

    let half = 0.5 * angle;
    let (sine, cosine) = half.sin_cos();
    // Forces are along the straight ends.
    let pulls = [
        (0, less * Vec3::new(-cosine, 0.0, -sine)),
        (SIZE[0] - 1, more * Vec3::new(cosine, 0.0, -sine)),
    ];
    // Forces are shared by the particles of an end in proportion to their masses.
    let areas = fabric.particle_areas();
    let row = |row: u32, column: u32| (row * SIZE[0] + column) as usize;
    let end_mass: f32 =
        (0..SIZE[1]).map(|at| areas[row(at, 0)]).sum::<f32>() * material.area_density;
    let tick = |strip: &mut Trial| {
        let part = (strip.ticks() as f32 / PULLING as f32).min(1.0);
        strip.tick_with(|particles| {
            for (column, force) in pulls {
                (0..SIZE[1]).for_each(|at| {
                    particles.add_acceleration(row(at, column), part * force / end_mass);
                });
            }
        });
    };
    let end = |strip: &Trial| strip.positions()[row(SIZE[1] / 2, SIZE[0] / 2)];
    (0..SETTLING).for_each(|_| tick(&mut strip));
    let before = end(&strip);
    (0..HOLDING).for_each(|_| tick(&mut strip));
    (end(&strip).distance(before) > SLIPPED, strip.us())
}
