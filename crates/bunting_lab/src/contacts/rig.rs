//! A cloth among colliders, with the time that its ticks take.

use std::f32::consts::TAU;
use std::sync::Arc;
use std::time::{Duration, Instant};

use bunting_solver::{
    ClothBatch, ClothSnapshot, Collider, Drive, Fabric, FabricBuilder, FabricMaterial, Grid,
    LaneCount, ParticlesMut, SelfCollision, StepLimits, StepSettings, SurfaceLift,
};
use glam::{Quat, Vec3};

use crate::flight::almost_at_rest;
use crate::need::Need;
use crate::product::{DEFAULT, TICK};

/// Acceleration of gravity, m/s².
pub(super) const GRAVITY: f32 = 9.81;
/// Distance that the cloth keeps from shapes, m.
pub(super) const THICKNESS: f32 = 2e-3;

/// Cotton in a vacuum, undamped, of a given coefficient of friction.
pub(super) fn cotton(friction: f32) -> FabricMaterial {
    FabricMaterial {
        damping: 0.0,
        pressure_coefficient: 0.0,
        friction_coefficient: 0.0,
        thickness: THICKNESS,
        surface_friction: friction,
        ..FabricMaterial::COTTON
    }
}

/// A free sheet in its xy plane, of the given numbers of columns and rows and the given size, m: x from 0 to the
/// width, y from 0 down to the negative height.
pub(super) fn sheet(columns: u32, rows: u32, width: f32, height: f32) -> Arc<Fabric> {
    let grid = FabricBuilder::grid(Grid::new(columns, rows, width, height));
    Arc::new(grid.build().expect("a good grid"))
}

/// A flag of 33² on a pole, almost at rest.
pub(super) fn hoisted() -> (Arc<Fabric>, ClothSnapshot) {
    let grid = FabricBuilder::grid(Grid::new(33, 33, 1.0, 1.0));
    let fabric = Arc::new(grid.pin_where(|_, uv| uv.x == 0.0).build().expect("a good grid"));
    let start = almost_at_rest(&fabric);
    (fabric, start)
}

/// Wind of 10 m/s that turns and fades for moments, m/s, given how far it turns slowly and quickly, rad.
pub(super) fn turning_wind(time: f32, [slowly, quickly]: [f32; 2]) -> Vec3 {
    let wave = |frequency: f32| (TAU * frequency * time).sin();
    let strength = 10.0 * (0.6 + 0.4 * wave(0.37));
    let angle = slowly * wave(0.23) + quickly * wave(0.61);
    strength * Vec3::new(angle.cos(), 0.15 * wave(0.83), angle.sin())
}

/// The default settings with another number of substeps.
pub(super) const fn substeps(count: u32) -> StepSettings {
    StepSettings { substeps: count, ..DEFAULT }
}

/// One cloth among colliders.
pub(super) struct Trial {
    pub batch: ClothBatch,
    pub material: FabricMaterial,
    pub drive: Drive,
    /// The settings of all ticks; none: substeps follow from need.
    settings: Option<StepSettings>,
    need: Need,
    pub colliders: Vec<Collider>,
    ticks: u32,
    time: Duration,
}

impl Trial {
    /// A cloth at rest under the given gravity, m/s².
    pub fn new(fabric: &Arc<Fabric>, material: FabricMaterial, gravity: Vec3) -> Self {
        Self::moving(fabric, material, gravity, |_| Vec3::ZERO)
    }

    /// A cloth whose free particles have velocities (m/s) that depend on their positions.
    pub fn moving(
        fabric: &Arc<Fabric>,
        material: FabricMaterial,
        gravity: Vec3,
        velocity: impl Fn(Vec3) -> Vec3,
    ) -> Self {
        let mut start = ClothSnapshot::at_rest(fabric);
        for particle in 0..start.positions.len() {
            if !fabric.is_pinned(particle) {
                start.velocities[particle] = velocity(start.positions[particle]);
            }
        }
        Self::from(fabric, &start, material, gravity)
    }

    /// A cloth in a given state.
    pub fn from(
        fabric: &Arc<Fabric>,
        start: &ClothSnapshot,
        material: FabricMaterial,
        gravity: Vec3,
    ) -> Self {
        let mut batch = ClothBatch::new(Arc::clone(fabric), LaneCount::One);
        batch.insert(start, material).expect("a good cloth");
        let mut trial = Self {
            batch,
            material,
            drive: Drive::NONE,
            settings: None,
            need: Need::within(StepLimits::default()),
            colliders: Vec::new(),
            ticks: 0,
            time: Duration::ZERO,
        };
        trial.drive(Drive { gravity, ..Drive::NONE });
        trial
    }

    /// The trial with the same settings in all ticks.
    pub fn with(self, settings: StepSettings) -> Self {
        Self { settings: Some(settings), ..self }
    }

    /// Sets what acts on the cloth from the next tick on.
    pub fn drive(&mut self, drive: Drive) {
        self.batch.drive(0, drive).expect("a good drive");
        self.drive = drive;
    }

    /// Sets the colliders from the next tick on.
    pub fn touch(&mut self, colliders: impl IntoIterator<Item = Collider>) {
        self.colliders = colliders.into_iter().collect();
        self.batch.set_colliders(0, self.colliders.iter().cloned()).expect("good colliders");
    }

    /// Keeps layers of the cloth at a distance from one another, m; none: they may pass through one another.
    pub fn keep_layers_apart(&mut self, distance: Option<f32>) {
        let settings = distance.map(|thickness| SelfCollision { thickness });
        self.batch.set_self_collision(0, settings).expect("a good thickness");
    }

    /// The settings that the next tick will have.
    pub fn next_settings(&self) -> StepSettings {
        let by_need = || self.need.clone().settings(self.batch.fabric(), &self.drive, TICK);
        self.settings.unwrap_or_else(by_need)
    }

    /// Advances by a tick.
    pub fn tick(&mut self) {
        self.tick_with(|_| ());
    }

    /// Advances by a tick, with forces that are added in each substep.
    pub fn tick_with(&mut self, mut forces: impl FnMut(&mut ParticlesMut<'_>)) {
        let before = self.positions();
        let by_need = || self.need.settings(self.batch.fabric(), &self.drive, TICK);
        let settings = self.settings.unwrap_or_else(by_need);
        let start = Instant::now();
        self.batch.begin_tick(TICK, settings);
        for _ in 0..settings.substeps {
            self.batch.integrate();
            forces(&mut self.batch.particles_mut(0).expect("a cloth"));
            self.batch.solve_constraints();
            self.batch.update_velocities();
        }
        self.time += start.elapsed();
        self.ticks += 1;
        let after = self.positions();
        self.need.note(&self.batch, &self.material, &self.drive, [&before, &after], TICK);
    }

    /// Advances by some seconds.
    pub fn run(&mut self, seconds: f32) {
        (0..(seconds / TICK).round() as usize).for_each(|_| self.tick());
    }

    /// Positions of all particles, m.
    pub fn positions(&self) -> Vec<Vec3> {
        let mut positions = Vec::new();
        self.batch.copy_positions(0, &mut positions);
        positions
    }

    /// Positions of the displayed surface's vertices, m: with the displacements by [`SurfaceLift`].
    pub fn displayed(&self) -> Vec<Vec3> {
        let mut positions = self.positions();
        let mut lifts = Vec::new();
        let fabric = self.batch.fabric();
        let near = self.batch.near_colliders(0);
        SurfaceLift::default().compute(
            fabric,
            &positions,
            self.material.thickness,
            near,
            &mut lifts,
        );
        lifts.iter().for_each(|&(particle, lift)| positions[particle as usize] += lift);
        positions
    }

    /// Mean of all particles' positions, m.
    pub fn centre(&self) -> Vec3 {
        let positions = self.positions();
        positions.iter().sum::<Vec3>() / positions.len() as f32
    }

    /// Number of ticks so far.
    pub fn ticks(&self) -> u32 {
        self.ticks
    }

    /// Mean time of a tick, µs.
    pub fn us(&self) -> f64 {
        1e6 * self.time.as_secs_f64() / f64::from(self.ticks.max(1))
    }
}

/// A collider that moves along a straight line in a tick.
pub(super) fn moving(collider: &Collider, from: Vec3, to: Vec3) -> Collider {
    Collider { from: (from, collider.from.1), to: (to, collider.to.1), ..collider.clone() }
}

/// A half space below z = −thickness, on which a sheet in the plane z = 0 lies.
pub(super) fn floor(friction: f32) -> Collider {
    let shape = parry3d::shape::SharedShape::halfspace(Vec3::Z);
    Collider { friction, ..Collider::fixed(shape, -THICKNESS * Vec3::Z, Quat::IDENTITY) }
}

/// The threshold between `low`, where a cloth does not slip, and `high`, where it does, and the time of a tick in the last
/// trial, µs. `slips` tells whether the cloth slips, and that time.
pub(super) fn threshold(
    mut low: f32,
    mut high: f32,
    slips: impl Fn(f32) -> (bool, f64),
) -> (f32, f64) {
    /// Halvings: 2⁻¹⁰ of the interval remains.
    const HALVINGS: usize = 10;
    let mut us = 0.0;
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        let (has_slipped, time) = slips(middle);
        if has_slipped {
            high = middle;
        } else {
            low = middle;
        }
        us = time;
    }
    (0.5 * (low + high), us)
}
