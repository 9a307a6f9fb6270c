//! A batch of cloths of one fabric, one in each lane.

use std::sync::Arc;

use glam::Vec3;

use crate::batch::lane_batch::LaneBatch;
use crate::batch::lane_count::LaneCount;
use crate::batch::snapshot::ClothSnapshot;
use crate::contact::collider::Collider;
use crate::fabric::{Fabric, FabricError, FabricMaterial};
use crate::simd::lane::{Pack1, Pack8, Pack16};
use crate::step::bdf::Past;
use crate::step::{Drive, Scheme, StepSettings};

/// Why a cloth cannot ride in a batch.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BatchError {
    /// Every lane is taken.
    #[error("all {lanes} lanes are taken")]
    Full {
        /// Number of lanes.
        lanes: usize,
    },
    /// The state is of another fabric.
    #[error("the state has {given} particles, the fabric {expected}")]
    ParticleCount {
        /// Particles in the state.
        given: usize,
        /// Particles in the fabric.
        expected: usize,
    },
    /// The state is infinite or not a number.
    #[error("the state is not finite")]
    NotFinite,
    /// The material cannot be simulated.
    #[error(transparent)]
    Material(#[from] FabricError),
}

/// What a lane shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LaneSurface {
    /// Positions of the particles in the cloth's frame, m.
    pub positions: Vec<Vec3>,
    /// Unit normals of the particles, as of the last
    /// [`compute_normals`](ClothBatch::compute_normals).
    pub normals: Vec<Vec3>,
    /// Whether all positions are finite, and their sum.
    pub is_finite: bool,
}

/// The state of up to [`LaneCount`] cloths of one [`Fabric`], stepped together.
///
/// A lane's bits depend on its own history only.
#[derive(Clone, Debug)]
pub struct ClothBatch(Width);

#[derive(Clone, Debug)]
enum Width {
    One(Box<LaneBatch<Pack1>>),
    /// One cloth that has all lanes to itself.
    Woven(Box<LaneBatch<Pack8, Pack8>>),
    Eight(Box<LaneBatch<Pack8>>),
    Sixteen(Box<LaneBatch<Pack16>>),
}

/// Does the same with a batch of any width.
macro_rules! at_any_width {
    ($batch:expr, $lanes:ident => $body:expr) => {
        match $batch {
            Width::One($lanes) => $body,
            Width::Woven($lanes) => $body,
            Width::Eight($lanes) => $body,
            Width::Sixteen($lanes) => $body,
        }
    };
}

impl ClothBatch {
    /// An empty batch.
    #[must_use]
    pub fn new(fabric: Arc<Fabric>, lanes: LaneCount) -> Self {
        Self(match lanes {
            LaneCount::One => match LaneBatch::woven_of(&fabric) {
                Some(woven) => Width::Woven(Box::new(woven)),
                None => Width::One(Box::new(LaneBatch::new(fabric))),
            },
            LaneCount::Eight => Width::Eight(Box::new(LaneBatch::new(fabric))),
            LaneCount::Sixteen => Width::Sixteen(Box::new(LaneBatch::new(fabric))),
        })
    }

    /// The fabric that all its cloths are cut from.
    #[must_use]
    pub fn fabric(&self) -> &Arc<Fabric> {
        at_any_width!(&self.0, batch => &batch.fabric)
    }

    /// Number of lanes.
    #[must_use]
    pub fn lane_count(&self) -> usize {
        at_any_width!(&self.0, batch => batch.slots.len())
    }

    /// Lanes that hold a cloth.
    pub fn occupied(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.lane_count()).filter(|&lane| self.is_occupied(lane))
    }

    /// Whether a lane holds a cloth.
    #[must_use]
    pub fn is_occupied(&self, lane: usize) -> bool {
        at_any_width!(&self.0, batch => batch.slots.get(lane).is_some_and(Option::is_some))
    }

    /// Whether no lane is free.
    #[must_use]
    pub fn is_full(&self) -> bool {
        at_any_width!(&self.0, batch => batch.slots.iter().all(Option::is_some))
    }

    /// Whether no lane holds a cloth.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        at_any_width!(&self.0, batch => batch.slots.iter().all(Option::is_none))
    }

    /// Lets the integrator of a lane begin anew: its next substep is of first order.
    pub(crate) fn forget_past(&mut self, lane: usize) {
        at_any_width!(&mut self.0, batch => {
            if let Some(slot) = &mut batch.slots[lane] {
                slot.past = Past::default();
            }
        });
    }

    /// Puts a cloth into the first free lane and returns the lane.
    ///
    /// # Errors
    ///
    /// No lane is free, the material is bad, or the state is not finite or of another fabric. The
    /// batch is then as it was.
    pub fn insert(
        &mut self,
        snapshot: &ClothSnapshot,
        material: FabricMaterial,
    ) -> Result<usize, BatchError> {
        let lanes = self.lane_count();
        let lane =
            (0..lanes).find(|&lane| !self.is_occupied(lane)).ok_or(BatchError::Full { lanes })?;
        self.replace(lane, snapshot, material)?;
        Ok(lane)
    }

    /// Puts a cloth into a lane, in the place of any that is there.
    ///
    /// # Errors
    ///
    /// The material is bad, or the state is not finite or of another fabric. The batch is then as it
    /// was.
    pub fn replace(
        &mut self,
        lane: usize,
        snapshot: &ClothSnapshot,
        material: FabricMaterial,
    ) -> Result<(), BatchError> {
        self.exchange(&[], &[(lane, snapshot, material)])
    }

    /// Takes cloths out of lanes, and puts others into lanes, in the place of any that are there: several take
    /// hardly longer than one.
    ///
    /// # Errors
    ///
    /// A material is bad, or a state is not finite or of another fabric. The batch is then as it was.
    pub fn exchange(
        &mut self,
        leave: &[usize],
        come: &[(usize, &ClothSnapshot, FabricMaterial)],
    ) -> Result<(), BatchError> {
        for (_, snapshot, material) in come {
            material.validate()?;
            self.check(snapshot)?;
        }
        at_any_width!(&mut self.0, batch => batch.exchange(leave, come));
        Ok(())
    }

    /// Takes the cloth out of a lane.
    pub fn remove(&mut self, lane: usize) {
        at_any_width!(&mut self.0, batch => batch.exchange(&[lane], &[]));
    }

    /// Overwrites the state of a lane. A state without a past is continued by one substep of first
    /// order.
    ///
    /// # Errors
    ///
    /// The state is not finite or of another fabric. The lane is then as it was.
    pub fn restore(&mut self, lane: usize, snapshot: &ClothSnapshot) -> Result<(), BatchError> {
        self.check(snapshot)?;
        at_any_width!(&mut self.0, batch => batch.restore(&[(lane, snapshot)]));
        Ok(())
    }

    fn check(&self, snapshot: &ClothSnapshot) -> Result<(), BatchError> {
        let expected = self.fabric().particle_count();
        for given in [snapshot.positions.len(), snapshot.velocities.len()] {
            if given != expected {
                return Err(BatchError::ParticleCount { given, expected });
            }
        }
        if snapshot.is_finite() { Ok(()) } else { Err(BatchError::NotFinite) }
    }

    /// Changes the material of a lane from the next tick on. An empty lane stays empty.
    ///
    /// # Errors
    ///
    /// The material cannot be simulated. The lane keeps the one it has.
    pub fn set_material(
        &mut self,
        lane: usize,
        material: FabricMaterial,
    ) -> Result<(), FabricError> {
        material.validate()?;
        at_any_width!(&mut self.0, batch => {
            if let Some(slot) = &mut batch.slots[lane] {
                slot.material = material;
            }
        });
        Ok(())
    }

    /// Sets what acts on a lane from the next tick on. The frame's motion is repeated every tick
    /// until it is set anew.
    pub fn drive(&mut self, lane: usize, drive: Drive) {
        at_any_width!(&mut self.0, batch => {
            if let Some(slot) = &mut batch.slots[lane] {
                slot.drive = drive;
            }
        });
    }

    /// Sets what a lane may touch from the next tick on.
    pub fn set_colliders(&mut self, lane: usize, colliders: impl IntoIterator<Item = Collider>) {
        at_any_width!(&mut self.0, batch => {
            if let Some(slot) = &mut batch.slots[lane] {
                slot.colliders.clear();
                slot.colliders.extend(colliders);
            }
        });
    }

    /// Begins a tick of `tick` seconds: compliances for its substeps, contact candidates. In a tick of
    /// no time nothing moves.
    pub fn begin_tick(&mut self, tick: f32, settings: StepSettings) {
        if let Width::Woven(woven) = &self.0
            && settings.scheme != Scheme::Yarns
        {
            self.0 = Width::One(Box::new(woven.unwoven()));
        }
        at_any_width!(&mut self.0, batch => batch.begin_tick(tick, settings));
    }

    /// Begins a substep: external forces, damping, prediction.
    pub fn integrate(&mut self) {
        at_any_width!(&mut self.0, batch => batch.integrate());
    }

    /// Projects the predicted positions onto the constraints.
    pub fn solve_constraints(&mut self) {
        at_any_width!(&mut self.0, batch => batch.solve_constraints());
    }

    /// Ends a substep: velocities from the corrected positions.
    pub fn update_velocities(&mut self) {
        at_any_width!(&mut self.0, batch => batch.update_velocities());
    }

    /// Recomputes all normals from the positions.
    pub fn compute_normals(&mut self) {
        at_any_width!(&mut self.0, batch => batch.compute_normals());
    }

    /// One whole tick of `tick` seconds, normals and all.
    pub fn step(&mut self, tick: f32, settings: StepSettings) {
        self.begin_tick(tick, settings);
        for _ in 0..settings.substeps {
            self.integrate();
            self.solve_constraints();
            self.update_velocities();
        }
        self.compute_normals();
    }

    /// Positions of a lane's particles in the cloth's frame, m.
    pub fn copy_positions(&self, lane: usize, into: &mut Vec<Vec3>) {
        at_any_width!(&self.0, batch => batch.copy_positions(lane, into));
    }

    /// Velocities of a lane's particles relative to the world, along the frame's axes, m/s.
    pub fn copy_velocities(&self, lane: usize, into: &mut Vec<Vec3>) {
        at_any_width!(&self.0, batch => batch.copy_velocities(lane, into));
    }

    /// Unit normals of a lane's particles, as of the last
    /// [`compute_normals`](Self::compute_normals).
    pub fn copy_normals(&self, lane: usize, into: &mut Vec<Vec3>) {
        at_any_width!(&self.0, batch => batch.copy_normals(lane, into));
    }

    /// Positions and normals of all cloths at once, each into the place of its lane: much faster than
    /// lane by lane. A lane's surface is left alone where it holds no cloth.
    ///
    /// # Panics
    ///
    /// When there are fewer places than lanes.
    pub fn copy_surfaces(&self, into: &mut [LaneSurface]) {
        at_any_width!(&self.0, batch => batch.copy_surfaces(into));
    }

    /// The state of a lane, with what the integrator remembers.
    #[must_use]
    pub fn snapshot(&self, lane: usize) -> ClothSnapshot {
        at_any_width!(&self.0, batch => batch.snapshot(lane))
    }

    /// The state of a lane without what the integrator remembers.
    #[must_use]
    pub fn forgetful_snapshot(&self, lane: usize) -> ClothSnapshot {
        at_any_width!(&self.0, batch => batch.forgetful_snapshot(lane))
    }

    /// Positions and velocities of some of a lane's particles, as of a coarser fabric that shares them.
    #[must_use]
    pub fn snapshot_of(&self, lane: usize, particles: &[u32]) -> ClothSnapshot {
        at_any_width!(&self.0, batch => batch.snapshot_of(lane, particles))
    }

    /// Whether every number of a lane's state is finite.
    #[must_use]
    pub fn is_finite(&self, lane: usize) -> bool {
        at_any_width!(&self.0, batch => batch.is_finite(lane))
    }
}
