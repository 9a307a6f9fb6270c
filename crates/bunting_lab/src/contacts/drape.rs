//! A sheet on shapes that are finer than its mesh: no sample of a shape's surface may be seen through the displayed
//! surface.

use std::collections::HashMap;

use bunting_solver::{Collider, Fabric};
use glam::{Quat, Vec2, Vec3};
use parry3d::{
    query::PointQuery,
    shape::{SharedShape, TriMeshFlags, Triangle},
};

use super::{
    rig::{GRAVITY, Trial, cotton, moving, sheet},
    row::Row,
    shapes::{blob, samples},
};
use crate::{product::TICK, stats::worse};

/// Greatest height of a shape's surface above the cloth's, m.
const DEPTH: f64 = 3e-3;
/// Time after which depths are measured, s.
const SETTLING: f32 = 0.1;
/// Time between measurements, ticks.
const EVERY: usize = 4;
/// Distance between samples of a shape, m.
const SPACING: f32 = 4e-3;

/// A shape below the cloth, its highest point at the origin of its own frame once it is moved by `top`.
struct Feature {
    name: &'static str,
    shape: SharedShape,
    turn: Quat,
    /// Height of the highest point above the shape's origin, m.
    top: f32,
    /// Samples of the surface in the shape's frame.
    samples: Vec<Vec3>,
}

impl Feature {
    fn new(name: &'static str, shape: SharedShape, turn: Quat, mesh: Mesh) -> Self {
        let samples = samples(&mesh.0, &mesh.1, SPACING);
        let top = samples.iter().map(|at| (turn * *at).z).fold(f32::MIN, f32::max);
        Self { name, shape, turn, top, samples }
    }
}

/// Corners and triangles.
type Mesh = (Vec<Vec3>, Vec<[u32; 3]>);

pub(super) fn rows(quick: bool) -> Vec<Row> {
    let peg = SharedShape::cylinder(0.15, 0.01);
    let cone = SharedShape::cone(0.15, 0.1);
    let cuboid = SharedShape::cuboid(0.15, 0.15, 0.15);
    let upright = Quat::from_rotation_x(std::f32::consts::FRAC_PI_2);
    let on_corner = Quat::from_rotation_arc(Vec3::ONE.normalize(), Vec3::Z);
    let outline =
        |shape: &SharedShape| match (shape.as_cylinder(), shape.as_cone(), shape.as_cuboid()) {
            (Some(shape), _, _) => shape.to_trimesh(24),
            (_, Some(shape), _) => shape.to_trimesh(24),
            (_, _, Some(shape)) => shape.to_trimesh(),
            _ => unreachable!("a peg, a cone or a box"),
        };
    let (corners, triangles) = blob();
    let closed = TriMeshFlags::ORIENTED;
    let mesh = SharedShape::trimesh_with_flags(corners.clone(), triangles.clone(), closed);
    let mesh = mesh.expect("a good mesh");
    let of = |name, shape: SharedShape, turn| {
        let mesh = outline(&shape);
        Feature::new(name, shape, turn, mesh)
    };
    let features = [
        of("peg of 2 cm", peg, upright),
        of("corner of a box", cuboid, on_corner),
        of("tip of a cone", cone, upright),
        Feature::new("blob of 224 triangles", mesh, Quat::IDENTITY, (corners, triangles)),
    ];
    let speeds = [0.0, 2.0];
    let seconds = if quick { 0.5 } else { 2.0 };
    let cases = features.iter().flat_map(|feature| speeds.map(|speed| (feature, speed)));
    cases.map(|(feature, speed)| row(feature, speed, seconds)).collect()
}

/// Row of a sheet that falls on a shape, or that a shape hits from below. A shape that moves rises for 0.3 s.
fn row(feature: &Feature, speed: f32, seconds: f32) -> Row {
    /// Distance of the shape below the sheet, m.
    const GAP: f32 = 0.01;
    const RISING: f32 = 0.3;
    let fabric = sheet(33, 33, 1.0, 1.0);
    let mut cloth = Trial::new(&fabric, cotton(0.4), -GRAVITY * Vec3::Z);
    // The highest point is under a cell, at neither its middle nor a corner.
    let aim = Vec2::new(0.51, -0.492);
    let at = |tick: usize| {
        let risen = speed * (TICK * tick as f32).min(RISING);
        aim.extend(risen - feature.top - GAP)
    };
    let fixed = Collider::fixed(feature.shape.clone(), Vec3::ZERO, feature.turn);
    let collider = Collider { features: true, ..fixed };
    let mut deepest = 0.0;
    let seconds = if speed > 0.0 { RISING } else { seconds };
    for tick in 0..(seconds / TICK) as usize {
        cloth.touch([moving(&collider, at(tick), at(tick + 1))]);
        cloth.tick();
        if tick as f32 * TICK >= SETTLING && tick % EVERY == 0 {
            let surface = Surface::new(cloth.batch.fabric(), &cloth.displayed());
            for sample in &feature.samples {
                let sample = at(tick + 1) + feature.turn * *sample;
                deepest = worse(deepest, surface.below(sample).into());
            }
        }
    }
    let name = match speed {
        0.0 => format!("{}: dropped on it", feature.name),
        _ => format!("{}: rises at {speed} m/s", feature.name),
    };
    Row::new(name, "highest above the cloth, m", deepest, DEPTH, cloth.us())
}

/// Side of a cell of the plane, m, in which triangles are looked up.
const CELL: f32 = 0.02;

/// Longest side of a triangle that is looked up, m.
const LONGEST: f32 = 1.0;

/// The triangles of a cloth, and those over each cell of the plane.
pub(super) struct Surface {
    triangles: Vec<[Vec3; 3]>,
    over: HashMap<[i32; 2], Vec<usize>>,
}

impl Surface {
    /// The surface of a fabric whose particles are at these positions, m.
    pub fn new(fabric: &Fabric, positions: &[Vec3]) -> Self {
        let corners = fabric.triangles().iter();
        let triangles: Vec<[Vec3; 3]> =
            corners.map(|it| it.map(|corner| positions[corner as usize])).collect();
        let mut over = HashMap::<_, Vec<usize>>::new();
        for (index, [a, b, c]) in triangles.iter().enumerate() {
            // Exploded cloth covers nothing.
            if a.distance(*b).max(a.distance(*c)) > LONGEST {
                continue;
            }
            let [low, high] = [a.min(*b).min(*c), a.max(*b).max(*c)].map(|at| cell(at.truncate()));
            for (x, y) in (low[0]..=high[0]).flat_map(|x| (low[1]..=high[1]).map(move |y| (x, y))) {
                over.entry([x, y]).or_default().push(index);
            }
        }
        Self { triangles, over }
    }

    /// Distance from a point to the surface if the surface is below the point and nowhere above it, m; else zero.
    pub fn below(&self, at: Vec3) -> f32 {
        let over = self.over.get(&cell(at.truncate())).into_iter().flatten();
        let triangles = over.map(|&index| &self.triangles[index]);
        let heights = triangles.filter_map(|triangle| height(triangle, at.truncate()));
        let highest = heights.reduce(f32::max);
        if highest.is_none_or(|highest| highest >= at.z) {
            return 0.0;
        }
        let distance =
            |[a, b, c]: &[Vec3; 3]| Triangle::new(*a, *b, *c).distance_to_local_point(at, false);
        self.triangles.iter().map(distance).fold(f32::INFINITY, f32::min)
    }
}

/// The cell of the plane at a point.
fn cell(at: Vec2) -> [i32; 2] {
    (at / CELL).floor().as_ivec2().to_array()
}

/// Height of a triangle over a point of the plane; none beside it.
fn height([a, b, c]: &[Vec3; 3], at: Vec2) -> Option<f32> {
    let (low, high) = (a.min(*b).min(*c).truncate(), a.max(*b).max(*c).truncate());
    if at.cmplt(low).any() || at.cmpgt(high).any() {
        return None;
    }
    let (ab, ac, ap) = ((b - a).truncate(), (c - a).truncate(), at - a.truncate());
    let area = ab.perp_dot(ac);
    let (v, w) = (ap.perp_dot(ac) / area, ab.perp_dot(ap) / area);
    let inside = v >= 0.0 && w >= 0.0 && v + w <= 1.0;
    inside.then_some(a.z + v * (b - a).z + w * (c - a).z)
}
