//! Fast shapes and fast cloth: nothing may get through.

use std::sync::Arc;

use bunting_solver::{Collider, Fabric, FabricBuilder, Grid};
use glam::{Quat, Vec2, Vec3};
use parry3d::shape::SharedShape;

use super::{
    rig::{Trial, cotton, moving, sheet, substeps},
    row::Row,
    shapes::{lattice, wave, wavy_mesh},
};
use crate::{product::TICK, stats::worse};

/// Parts of a triangle's sides between which the displayed surface is sampled.
const PARTS: u32 = 4;
/// Parts of a tick that pass before the shape arrives at the cloth.
const PHASES: [f32; 3] = [1.1, 1.4, 1.8];
/// Greatest distance behind a shape's middle, m.
const BEHIND: f64 = 1e-3;
/// Greatest depth of cloth in a mesh, m.
const DEPTH: f64 = 3e-3;

pub(super) fn rows(quick: bool) -> Vec<Row> {
    let sizes = if quick { &[17][..] } else { &[17, 33, 65] };
    let mut rows = Vec::new();
    for (&n, steps) in sizes.iter().flat_map(|n| [1, 2, 4].map(|steps| (n, steps))) {
        let suffix = format!("{n}², {steps} substeps");
        let fabric = sheet(n, n, 1.0, 1.0);
        let ball = Shot::new(SharedShape::ball(0.05), 40.0, 0.025);
        rows.push(ball.row(format!("ball of 5 cm at 40 m/s, {suffix}"), &fabric, 1.0, steps));
        let plate = Shot::new(SharedShape::cuboid(0.15, 0.15, 0.005), 20.0, 0.12);
        rows.push(plate.row(format!("plate at 20 m/s, {suffix}"), &fabric, 1.0, steps));
        rows.push(thrown(format!("thrown at a mesh at 20 m/s, {suffix}"), n, steps));
    }
    for steps in [1, 2, 4] {
        let grid = FabricBuilder::grid(Grid::new(33, 33, 2.0, 2.0)).pin(0..33);
        let curtain = Arc::new(grid.build().expect("a good grid"));
        let ball = Shot { ticks: 2, ..Shot::new(SharedShape::ball(0.025), 20.0, 0.0125) };
        let name = format!("ball of 2.5 cm at 20 m/s at a curtain of 2 m, 33², {steps} substeps");
        rows.push(ball.row(name, &curtain, 2.0, steps));
    }
    rows
}

/// A shape that flies along z.
struct Shot {
    shape: SharedShape,
    /// m/s.
    speed: f32,
    /// Distance from the line of flight within which cloth must not pass the shape, m.
    radius: f32,
    /// Whole ticks after the impact.
    ticks: usize,
}

impl Shot {
    const fn new(shape: SharedShape, speed: f32, radius: f32) -> Self {
        Self { shape, speed, radius, ticks: 3 }
    }

    /// Row of the worst of several shots at a sheet of `side` m: at a particle and at the middle of a cell, at
    /// several phases of the tick.
    fn row(&self, name: String, fabric: &Arc<Fabric>, side: f32, steps: u32) -> Row {
        let cell = side / ((fabric.particle_count() as f32).sqrt() - 1.0);
        let (mut behind, mut us) = (0.0, 0.0);
        for aim in [Vec2::ZERO, Vec2::splat(0.5 * cell), Vec2::new(0.5 * cell, 0.1 * cell)] {
            for phase in PHASES {
                let at = Vec2::new(0.5, -0.5) * side + aim;
                let (farthest, time) = self.fire(fabric, at, phase, steps);
                behind = worse(behind, farthest);
                us = time;
            }
        }
        Row::new(name, "farthest behind the shape's middle, m", behind, BEHIND, us)
    }

    /// Farthest distance of a part of the surface in the shape's way behind its middle, m, and the time of a
    /// tick, µs.
    fn fire(&self, fabric: &Arc<Fabric>, aim: Vec2, phase: f32, steps: u32) -> (f64, f64) {
        let mut cloth = Trial::new(fabric, cotton(0.4), Vec3::ZERO).with(substeps(steps));
        let fixed = Collider::fixed(self.shape.clone(), Vec3::ZERO, Quat::IDENTITY);
        // The shapes are smaller than the cells of coarse sheets.
        let collider = Collider { features: true, ..fixed };
        let at = |tick: usize| aim.extend(self.speed * TICK * (tick as f32 - phase));
        let in_way = points(fabric, |rest| rest.truncate().distance(aim) < self.radius);
        let mut farthest = 0.0;
        for tick in 0..2 + self.ticks {
            cloth.touch([moving(&collider, at(tick), at(tick + 1))]);
            cloth.tick();
            let middle = at(tick + 1).z;
            if middle > 0.0 {
                let positions = cloth.displayed();
                for point in &in_way {
                    farthest = worse(farthest, (middle - point.on(&positions).z).into());
                }
            }
        }
        (farthest, cloth.us())
    }
}

/// Row of a sheet that flies at 20 m/s against an open mesh of triangles with legs of 1 cm.
fn thrown(name: String, n: u32, steps: u32) -> Row {
    const SPEED: f32 = 20.0;
    /// Side of the sheet, half side of the mesh, and half side of the part in which depths are measured, m.
    const SIDE: f32 = 0.5;
    const HALF: f32 = 0.4;
    const INNER: f32 = 0.35;
    // The mesh is larger than the sheet, so that nothing flies past it and folds behind it.
    let fabric = sheet(n, n, SIDE, SIDE);
    let middle = Vec3::new(0.5 * SIDE, -0.5 * SIDE, -0.4);
    let velocity = |_| -SPEED * Vec3::Z;
    let mut cloth = Trial::moving(&fabric, cotton(0.4), Vec3::ZERO, velocity).with(substeps(steps));
    cloth.touch([Collider::fixed(wavy_mesh(HALF, 0.01), middle, Quat::IDENTITY)]);
    let points = points(&fabric, |_| true);
    let mut deepest = 0.0;
    for _ in 0..10 {
        cloth.tick();
        let positions = cloth.displayed();
        for point in &points {
            let at = point.on(&positions) - middle;
            if at.truncate().abs().max_element() < INNER {
                deepest = worse(deepest, (wave(at.truncate()) - at.z).into());
            }
        }
    }
    Row::new(name, "deepest behind the mesh, m", deepest, DEPTH, cloth.us())
}

/// A point of the surface, given by its triangle and its barycentric coordinates.
struct Point {
    corners: [usize; 3],
    weights: [f32; 3],
}

impl Point {
    fn on(&self, positions: &[Vec3]) -> Vec3 {
        self.corners.iter().zip(self.weights).map(|(&at, weight)| positions[at] * weight).sum()
    }
}

/// Points of a fabric's triangles whose positions at rest are selected.
fn points(fabric: &Fabric, selected: impl Fn(Vec3) -> bool) -> Vec<Point> {
    let rest = fabric.rest_positions();
    let of_triangle = |triangle: &[u32; 3]| {
        let corners = triangle.map(|corner| corner as usize);
        lattice(PARTS).into_iter().map(move |weights| Point { corners, weights })
    };
    let all = fabric.triangles().iter().flat_map(of_triangle);
    all.filter(|point| selected(point.on(rest))).collect()
}
