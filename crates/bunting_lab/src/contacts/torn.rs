//! Pinned cloth that a shape would tear, as it leaves particles no place on its side: the shape passes through, and the
//! cloth hangs unstretched.

use std::sync::Arc;

use bunting_solver::{Collider, FabricBuilder, FabricMaterial, Grid, StepSettings};
use glam::{Quat, Vec3};
use parry3d::shape::SharedShape;

use super::{
    rig::{GRAVITY, Trial, cotton, moving, substeps},
    row::Row,
};
use crate::{product::TICK, stats::worse};

/// Particles of a row and of a column of a sheet of a metre.
const SIZE: u32 = 33;

/// Greatest strain of a link, of one: links beside a shape may be bent around its edge.
const STRAIN: f64 = 0.1;

/// The same where cloth is caught on the edges of a shape around its pins: its links may have four lengths.
const CAUGHT: f64 = 3.0;

/// Damping, 1/s: without it a sheet swings for long when a shape has let it go.
const DAMPING: f32 = 2.0;

/// Time after which strain is measured, and for how long, s.
const SECONDS: [f32; 2] = [6.0, 1.0];

pub(super) fn rows(quick: bool) -> Vec<Row> {
    /// Height at which a post stops in the sheet, drawn out to 1.4 times its length, m.
    const STOPS_AT: f32 = 0.5;
    let steps: &[u32] = if quick { &[2] } else { &[1, 2, 4] };
    let of_steps = |&steps: &u32| {
        [
            driven("goes on", 2.0, steps),
            driven("stops", STOPS_AT, steps),
            with_pins_within("pole", SharedShape::capsule_y(2.0, 0.08), STRAIN, steps),
            with_pins_within("box", SharedShape::cuboid(0.25, 0.2, 0.1), CAUGHT, steps),
        ]
    };
    steps.iter().flat_map(of_steps).collect()
}

/// A sheet that is held at its left side, or at both.
fn held(both: bool, settings: StepSettings) -> Trial {
    let grid = FabricBuilder::grid(Grid::new(SIZE, SIZE, 1.0, 1.0));
    let held = grid.pin_where(|_, uv| uv.x == 0.0 || both && uv.x == 1.0);
    let fabric = Arc::new(held.build().expect("a good grid"));
    let material = FabricMaterial { damping: DAMPING, ..cotton(0.4) };
    Trial::new(&fabric, material, -GRAVITY * Vec3::Z).with(settings)
}

/// Greatest strain of any link in the last second.
fn strain(cloth: &mut Trial) -> f64 {
    let [before, during] = SECONDS;
    cloth.run(before);
    let mut worst = 0.0;
    for _ in 0..(during / TICK).round() as usize {
        cloth.tick();
        let positions = cloth.positions();
        for link in cloth.batch.fabric().links() {
            let [from, to] = link.particles.map(|it| positions[it as usize]);
            worst = worse(worst, (from.distance(to) / link.rest_length - 1.0).into());
        }
    }
    worst
}

/// Row of a post that is driven through a sheet between two held sides, up to a height above it, m.
fn driven(what: &str, height: f32, steps: u32) -> Row {
    /// m/s.
    const SPEED: f32 = 10.0;
    let mut cloth = held(true, substeps(steps));
    let post = Collider::fixed(SharedShape::capsule_y(2.0, 0.05), Vec3::ZERO, Quat::IDENTITY);
    let place = |height: f32| Vec3::new(0.5, -0.5, height);
    let mut at = -0.2;
    while at < height {
        let next = (at + SPEED * TICK).min(height);
        cloth.touch([moving(&post, place(at), place(next))]);
        cloth.tick();
        at = next;
    }
    cloth.touch([moving(&post, place(at), place(at))]);
    let strain = strain(&mut cloth);
    let name = format!("post that {what} through a held sheet, {steps} substeps");
    Row::new(name, "greatest strain of a link at rest", strain, STRAIN, cloth.us())
}

/// Row of a sheet whose pins are within a shape.
fn with_pins_within(name: &str, shape: SharedShape, limit: f64, steps: u32) -> Row {
    let mut cloth = held(false, substeps(steps));
    cloth.touch([Collider::fixed(shape, Vec3::new(0.0, -0.5, 0.0), Quat::IDENTITY)]);
    let strain = strain(&mut cloth);
    let name = format!("sheet with its pins in a {name}, {steps} substeps");
    Row::new(name, "greatest strain of a link at rest", strain, limit, cloth.us())
}
