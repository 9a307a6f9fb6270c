//! The state of a batch at one width.

use std::sync::Arc;

use glam::Vec3;

use crate::collision::Collider;
use crate::fabric::{Fabric, FabricMaterial};
use crate::lanes::Pack;
use crate::parameters::Parameters;
use crate::snapshot::ClothSnapshot;
use crate::step::{Drive, StepSettings};
use crate::vector::{Pack3, lane3, set_lane3, splat3};

/// One cloth's place in a batch: what the lanes do not hold.
#[derive(Clone, Debug)]
pub(crate) struct Slot {
    pub material: FabricMaterial,
    pub drive: Drive,
    pub colliders: Vec<Collider>,
    /// For each collider, the particles that may touch it in this tick.
    pub contacts: Vec<Vec<u32>>,
}

/// Up to `P::WIDTH` cloths of one fabric.
#[derive(Clone, Debug)]
pub(crate) struct LaneBatch<P: Pack> {
    pub fabric: Arc<Fabric>,
    pub slots: Vec<Option<Slot>>,

    /// Positions in the cloth's frame, m.
    pub position: Vec<Pack3<P>>,
    /// Positions as predicted at the start of the substep, before any correction, m.
    pub predicted: Vec<Pack3<P>>,
    /// Velocities relative to the world along the frame's axes, m/s.
    pub velocity: Vec<Pack3<P>>,
    /// Unit normals.
    pub normal: Vec<Pack3<P>>,
    /// Sum over a particle's triangles of area times change of velocity, m³/s.
    pub air_impulse: Vec<Pack3<P>>,

    /// Multipliers of links and hinges, kept from pass to pass of a substep.
    pub link_multiplier: Vec<P>,
    pub hinge_multiplier: Vec<P>,

    pub parameters: Parameters<P>,
    pub clock: Clock,
}

/// Where in the tick the batch is.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Clock {
    pub settings: StepSettings,
    /// Length of a substep, s.
    pub step: f32,
    /// Substeps done in this tick.
    pub done: u32,
}

impl<P: Pack> LaneBatch<P> {
    pub fn new(fabric: Arc<Fabric>) -> Self {
        let rest: Vec<Pack3<P>> =
            fabric.rest_positions().iter().map(|&rest| splat3(rest)).collect();
        let zero = vec![splat3(Vec3::ZERO); rest.len()];
        let nothing = P::splat(0.0);
        Self {
            slots: vec![None; P::WIDTH],
            predicted: rest.clone(),
            position: rest,
            velocity: zero.clone(),
            air_impulse: zero.clone(),
            normal: zero,
            link_multiplier: vec![nothing; fabric.links().len()],
            hinge_multiplier: vec![nothing; fabric.hinges().len()],
            parameters: Parameters::new(&fabric),
            clock: Clock::default(),
            fabric,
        }
    }

    pub fn insert(&mut self, lane: usize, snapshot: &ClothSnapshot, material: FabricMaterial) {
        self.slots[lane] = Some(Slot {
            material,
            drive: Drive::default(),
            colliders: Vec::new(),
            contacts: Vec::new(),
        });
        self.restore(lane, snapshot);
    }

    /// Empties a lane; it then lies at rest, so that its arithmetic stays finite.
    pub fn remove(&mut self, lane: usize) {
        self.slots[lane] = None;
        let rest = ClothSnapshot::at_rest(&self.fabric);
        self.restore(lane, &rest);
    }

    pub fn restore(&mut self, lane: usize, snapshot: &ClothSnapshot) {
        for (particle, (&position, &velocity)) in
            snapshot.positions.iter().zip(&snapshot.velocities).enumerate()
        {
            set_lane3(&mut self.position[particle], lane, position);
            set_lane3(&mut self.predicted[particle], lane, position);
            let velocity = if self.fabric.is_pinned(particle) { Vec3::ZERO } else { velocity };
            set_lane3(&mut self.velocity[particle], lane, velocity);
        }
    }

    pub fn copy_positions(&self, lane: usize, into: &mut Vec<Vec3>) {
        into.clear();
        into.extend(self.position.iter().map(|pack| lane3(pack, lane)));
    }

    pub fn copy_velocities(&self, lane: usize, into: &mut Vec<Vec3>) {
        into.clear();
        into.extend(self.velocity.iter().map(|pack| lane3(pack, lane)));
    }

    pub fn copy_normals(&self, lane: usize, into: &mut Vec<Vec3>) {
        into.clear();
        into.extend(self.normal.iter().map(|pack| lane3(pack, lane)));
    }

    pub fn is_finite(&self, lane: usize) -> bool {
        let finite = |packs: &[Pack3<P>]| packs.iter().all(|pack| lane3(pack, lane).is_finite());
        finite(&self.position) && finite(&self.velocity)
    }

    /// Sets everything that is constant over the tick, and gathers contacts.
    pub fn begin_tick(&mut self, tick: f32, settings: StepSettings) {
        let step = tick / settings.substeps as f32;
        self.clock = Clock { settings, step, done: 0 };
        for (lane, slot) in self.slots.iter().enumerate() {
            let (material, air_density) = match slot {
                Some(slot) => (slot.material, slot.drive.air_density),
                None => (FabricMaterial::default(), 0.0),
            };
            self.parameters.set_material(lane, &self.fabric, &material, air_density, step);
        }
        self.gather_contacts(tick);
    }

    /// Sets everything that is constant over the substep.
    pub fn begin_substep(&mut self) {
        let moved = self.parameters.moves_any();
        for (lane, slot) in self.slots.iter().enumerate() {
            let drive = slot.as_ref().map_or(Drive::NONE, |slot| slot.drive);
            self.parameters.set_drive(lane, &drive, &self.clock);
        }
        // One substep more than the motion lasts, so that pinned particles come to rest.
        self.parameters.carries = moved || self.parameters.moves_any();
    }
}
