//! Sheets that fall on a ball, a box and a mesh, in this project and in rapier: the same particles, links, masses,
//! thickness and friction.

use bunting_solver::{Collider, Fabric, FabricMaterial, Link, LinkFamily};
use glam::{Quat, Vec3};
use parry3d::shape::{SharedShape, TriMeshFlags};
use rapier3d::prelude::{ColliderBuilder, TriMeshFlags as RapierFlags, Vector};
use serde::Serialize;

use super::{
    drape::Surface,
    rig::{GRAVITY, Trial, cotton, sheet, substeps},
    shapes::{blob, samples},
};
use crate::{
    peers::rapier::Rapier,
    simulation::{Simulation, in_double},
    stats::{mean, rms_length, worse},
    timing::Timing,
};

/// Substeps of this project and of rapier; the first of each is its default.
const OWN: [u32; 2] = [2, 4];
const RAPIER: [usize; 2] = [4, 20];
/// Radius of the ball and half the side of the box, m.
const RADIUS: f32 = 0.25;
const HALF: f32 = 0.2;
/// Distance of the shape below the sheet, m.
const GAP: f32 = 0.05;
/// Damping, 1/s, with which the sheets come to rest.
const DAMPING: f32 = 2.0;
/// Time after which depths are measured, time between measurements, and the whole time, ticks.
const SETTLING: usize = 30;
const EVERY: usize = 10;
const TICKS: usize = 240;
/// Distance between samples of a shape, m.
const SPACING: f32 = 1e-2;

/// One engine on one shape.
#[derive(Clone, Debug, Serialize)]
pub struct Drape {
    /// Shape.
    pub shape: &'static str,
    /// Engine.
    pub engine: &'static str,
    /// Substeps a tick.
    pub substeps: usize,
    /// Greatest height of a sample of the shape's surface above the simulated triangles after 0.5 s, m.
    pub depth_m: f64,
    /// RMS speed after 4 s, m/s.
    pub speed: Option<f64>,
    /// Mean of |ε| over warp and weft after 4 s.
    pub mean_strain: Option<f64>,
    /// Median time of a tick, µs.
    pub us: f64,
}

/// A shape for both engines, with samples of its surface.
struct Shape {
    name: &'static str,
    own: SharedShape,
    rapier: ColliderBuilder,
    samples: Vec<Vec3>,
}

impl Shape {
    fn new(
        name: &'static str,
        own: SharedShape,
        rapier: ColliderBuilder,
        (corners, triangles): &(Vec<Vec3>, Vec<[u32; 3]>),
    ) -> Self {
        Self { name, own, rapier, samples: samples(corners, triangles, SPACING) }
    }
}

/// Every shape.
fn shapes() -> [Shape; 3] {
    let (ball, cuboid) = (SharedShape::ball(RADIUS), SharedShape::cuboid(HALF, HALF, HALF));
    let of_ball = ball.as_ball().expect("a ball").to_trimesh(48, 24);
    let of_cuboid = cuboid.as_cuboid().expect("a box").to_trimesh();
    let of_blob = blob();
    let (corners, triangles) = of_blob.clone();
    let points = corners.iter().map(|at| Vector::new(at.x, at.y, at.z)).collect();
    let rapier_blob =
        ColliderBuilder::trimesh_with_flags(points, triangles.clone(), RapierFlags::ORIENTED)
            .expect("a good mesh");
    let own_blob = SharedShape::trimesh_with_flags(corners, triangles, TriMeshFlags::ORIENTED)
        .expect("a good mesh");
    [
        Shape::new("ball", ball, ColliderBuilder::ball(RADIUS), &of_ball),
        Shape::new("box", cuboid, ColliderBuilder::cuboid(HALF, HALF, HALF), &of_cuboid),
        Shape::new("mesh of 224 triangles", own_blob, rapier_blob, &of_blob),
    ]
}

/// Every engine on every shape.
#[must_use]
pub fn drapes(quick: bool) -> Vec<Drape> {
    let fabric = sheet(33, 33, 1.0, 1.0);
    let material = FabricMaterial { damping: DAMPING, ..cotton(0.4) };
    let gravity = -GRAVITY * Vec3::Z;
    let settings = if quick { 1 } else { 2 };
    let mut drapes = Vec::new();
    for shape in &shapes() {
        let top = shape.samples.iter().map(|at| at.z).fold(f32::MIN, f32::max);
        let at = Vec3::new(0.5, -0.5, -top - GAP);
        for &count in &OWN[..settings] {
            let mut trial = Trial::new(&fabric, material, gravity).with(substeps(count));
            trial.touch([Collider::fixed(shape.own.clone(), at, Quat::IDENTITY)]);
            let own = Own { trial, positions: Vec::new(), velocities: Vec::new() };
            drapes.push(drape(("bunting", count as usize), (shape, at), &fabric, own));
        }
        for &count in &RAPIER[..settings] {
            let collider = shape.rapier.clone().translation(Vector::new(at.x, at.y, at.z));
            let rapier = Rapier::beside(&fabric, &material, collider, gravity, count);
            drapes.push(drape(("rapier 0.36", count), (shape, at), &fabric, rapier));
        }
    }
    drapes
}

/// Runs one engine on a shape at a place, m.
fn drape(
    (engine, substeps): (&'static str, usize),
    (shape, place): (&Shape, Vec3),
    fabric: &Fabric,
    mut cloth: impl Simulation,
) -> Drape {
    let mut time = Timing::default();
    let mut depth_m = 0.0;
    for tick in 0..TICKS {
        time.time(|| cloth.tick());
        if tick >= SETTLING && tick % EVERY == 0 {
            let surface = Surface::new(fabric, cloth.positions());
            for sample in &shape.samples {
                depth_m = worse(depth_m, surface.below(place + *sample).into());
            }
        }
    }
    let at = cloth.positions();
    let yarns = fabric.links().iter().filter(|link| link.family != LinkFamily::Diagonal);
    let strain = |link: &Link| {
        let [a, b] = link.particles.map(|particle| at[particle as usize]);
        f64::from((a.distance(b) / link.rest_length - 1.0).abs())
    };
    let strains: Vec<f64> = yarns.map(strain).collect();
    let known = |value: f64| value.is_finite().then_some(value);
    Drape {
        shape: shape.name,
        engine,
        substeps,
        depth_m,
        speed: known(rms_length(&in_double(cloth.velocities()))),
        mean_strain: known(mean(&strains)),
        us: time.median(),
    }
}

/// This project's cloth.
struct Own {
    trial: Trial,
    positions: Vec<Vec3>,
    velocities: Vec<Vec3>,
}

impl Simulation for Own {
    fn tick(&mut self) {
        self.trial.tick();
        self.trial.batch.copy_positions(0, &mut self.positions);
        self.trial.batch.copy_velocities(0, &mut self.velocities);
    }

    fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    fn velocities(&self) -> &[Vec3] {
        &self.velocities
    }
}
