//! Rapier's soft bodies.
//!
//! Particles, masses and links are this project's. A link's spring is given by its natural frequency: √(k W)/2π gives
//! it the material's stiffness k, with W the sum of its inverse masses. Its damping ratio is rapier's default, 1.
//! Bending is rapier's dihedral constraint with its default softness, 10 Hz, which at 33 × 33 is near the 2·10⁻⁵ N·m of
//! the scenes. There is no wind.

use std::f32::consts::TAU;

use bunting_solver::{Fabric, FabricMaterial};
use glam::Vec3;
use rapier3d::prelude::*;

use super::peer::Peer;
use crate::{product, scenes::Scene, simulation::Simulation};

/// Damping ratio of rapier's default material.
const DAMPING_RATIO: f32 = 1.0;

/// Choice of rapier's solver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Elasticity {
    /// Constraints, projected in substeps.
    Constraints,
    /// Implicit, by conjugate gradients.
    Fem,
}

impl Elasticity {
    /// Description of the constraints, for a table.
    #[must_use]
    pub const fn description(self) -> &'static str {
        match self {
            Self::Constraints => "springs of the same stiffness, damping ratio 1, dihedrals 10 Hz",
            Self::Fem => "the same springs and dihedrals, solved implicitly",
        }
    }
}

/// A scene in its own rapier world.
pub struct Rapier {
    world: PhysicsWorld,
    cloth: SoftBodyHandle,
    pinned: Vec<usize>,
    positions: Vec<Vec3>,
    velocities: Vec<Vec3>,
}

impl Rapier {
    /// The scene at its start.
    #[must_use]
    pub fn new(scene: &Scene, elasticity: Elasticity, substeps: usize) -> Self {
        let start: Vec<Vec3> = scene.positions().iter().map(|x| x.as_vec3()).collect();
        Self::of(&product::fabric(scene), &start, scene, elasticity, substeps)
    }

    /// A fabric with the material and the surroundings of a scene, from given positions, m.
    #[must_use]
    pub fn of(
        fabric: &Fabric,
        start: &[Vec3],
        scene: &Scene,
        elasticity: Elasticity,
        substeps: usize,
    ) -> Self {
        let material = product::material(scene);
        let gravity = Vec3::new(0.0, -scene.gravity as f32, 0.0);
        let cloth = soft_body(fabric, start, &material).no_surface_collider();
        let cloth = cloth.solver(match elasticity {
            Elasticity::Constraints => SoftBodySolver::Constraints,
            Elasticity::Fem => SoftBodySolver::Fem,
        });
        let pinned =
            (0..fabric.particle_count()).filter(|&particle| fabric.is_pinned(particle)).collect();
        Self { pinned, ..Self::insert(cloth, gravity, substeps) }
    }

    /// A fabric at rest beside a shape that it touches, under gravity, m/s².
    #[must_use]
    pub fn beside(
        fabric: &Fabric,
        material: &FabricMaterial,
        shape: ColliderBuilder,
        gravity: Vec3,
        substeps: usize,
    ) -> Self {
        let friction = material.surface_friction;
        // The shape of this collider is replaced by the cloth's surface.
        let surface = ColliderBuilder::ball(1.0).friction(friction);
        let cloth = soft_body(fabric, fabric.rest_positions(), material)
            .surface_collider(surface)
            .particle_radius(material.thickness);
        let mut rapier = Self::insert(cloth, gravity, substeps);
        rapier.world.insert_collider(shape.friction(friction), None);
        rapier
    }

    /// A world with one cloth.
    fn insert(cloth: SoftBodyBuilder, gravity: Vec3, substeps: usize) -> Self {
        let mut world = PhysicsWorld::new();
        world.gravity = vector(gravity);
        world.integration_parameters.num_solver_iterations = substeps;
        let cloth = world.insert_soft_body(cloth);
        let (positions, velocities) = (Vec::new(), Vec::new());
        let mut rapier = Self { world, cloth, pinned: Vec::new(), positions, velocities };
        rapier.look();
        rapier
    }

    fn look(&mut self) {
        let cloth = &self.world.soft_bodies[self.cloth];
        let plain = |v: Vector| Vec3::new(v.x, v.y, v.z);
        self.positions = cloth.particle_positions().map(plain).collect();
        self.velocities = cloth.particle_velocities().map(plain).collect();
    }
}

/// A fabric as a soft body with particles at given positions, m.
fn soft_body(fabric: &Fabric, start: &[Vec3], material: &FabricMaterial) -> SoftBodyBuilder {
    let masses: Vec<f32> =
        fabric.particle_areas().iter().map(|area| area * material.area_density).collect();
    let inverse = |particle: u32| {
        let particle = particle as usize;
        if fabric.is_pinned(particle) { 0.0 } else { masses[particle].recip() }
    };
    let softness = |link: &bunting_solver::Link| {
        let stiffness = fabric.link_stiffness(link, material);
        let [a, b] = link.particles;
        let rate = (stiffness * (inverse(a) + inverse(b))).sqrt();
        SpringCoefficients::new(rate / TAU, DAMPING_RATIO)
    };
    let pinned = (0..fabric.particle_count()).filter(|&particle| fabric.is_pinned(particle));
    let mut cloth = SoftBodyBuilder::new(start.iter().copied().map(vector).collect())
        .edges(fabric.links().iter().map(|link| link.particles).collect())
        .surface(fabric.triangles().to_vec())
        .masses(masses.clone())
        .pinned_particles(pinned.map(|particle| particle as u32))
        .linear_damping(material.damping)
        .can_sleep(false);
    cloth.edge_softness = (0..).zip(fabric.links().iter().map(softness)).collect();
    let dihedrals = cloth.surface_dihedrals();
    cloth.dihedrals(dihedrals)
}

/// Conversion to rapier's version of glam.
fn vector(v: Vec3) -> Vector {
    Vector::new(v.x, v.y, v.z)
}

impl Simulation for Rapier {
    fn tick(&mut self) {
        self.world.step();
        self.look();
    }

    fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    fn velocities(&self) -> &[Vec3] {
        &self.velocities
    }
}

impl Peer for Rapier {
    fn teleport(&mut self, metres: f32) {
        let cloth = &mut self.world.soft_bodies[self.cloth];
        for &particle in &self.pinned {
            let target = cloth.particle_position(particle) + Vector::new(metres, 0.0, 0.0);
            cloth.set_particle_kinematic_target(particle, target);
        }
        self.tick();
    }

    fn hitch(&mut self, seconds: f32) {
        let tick = self.world.integration_parameters.dt;
        self.world.integration_parameters.dt = seconds;
        self.tick();
        self.world.integration_parameters.dt = tick;
    }
}
