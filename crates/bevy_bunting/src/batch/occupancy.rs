//! The occupancy of a batch: the cloth in each of its lanes.

use std::sync::Arc;
use std::time::Duration;

use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bunting_solver::{
    BatchError, ClothBatch, ClothSnapshot, Collider, Drive, Entering, FabricMaterial, Guide, Hold,
    Lacing, LaneCount, LaneSurface, MovingPin, PinGroups, Pressure, Seams, SelfCollision,
};
use parry3d::bounding_volume::Aabb;

use crate::batch::batch_kind::{BatchKind, FabricCount};

/// A cloth that waits for a lane.
#[derive(Debug)]
pub(crate) struct PendingCloth {
    pub entity: Entity,
    /// Index of its fabric in the group.
    pub fabric: usize,
    pub snapshot: ClothSnapshot,
    pub material: FabricMaterial,
}

/// The cloth in a lane, and its material.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Occupant {
    pub entity: Entity,
    /// Index of its fabric in the group.
    pub fabric: usize,
    pub material: FabricMaterial,
}

/// A batch and the cloths in its lanes.
#[derive(Debug)]
pub(crate) struct OccupiedBatch {
    pub batch: ClothBatch,
    /// The occupant of each lane; none for a free lane.
    pub occupants: Vec<Option<Occupant>>,
    /// Buffers in which surfaces are copied from the lanes to the cloths' states.
    pub surfaces: Vec<LaneSurface>,
    /// Box around the cloth in each lane in this tick, if there are colliders; see `ClothBatch::swept_bounds`.
    pub bounds: Vec<Option<Aabb>>,
    pub width: LaneCount,
    /// Number of substeps in this tick.
    pub substeps: u32,
    /// Whether the batch takes part in the current substep.
    pub joins: bool,
    /// Whether a cloth of the batch may touch another cloth in this tick, so that all their batches take each substep together.
    pub touches: bool,
    /// Fraction of the tick that has passed for the batch at the end of its current substep.
    pub covered: f32,
    /// Time that the batch has taken in this tick, if it is measured.
    pub time: Duration,
}

impl OccupiedBatch {
    /// A batch with free lanes only, of a group of these fabrics.
    pub fn new(kind: BatchKind, fabrics: &[FabricCount]) -> Self {
        let BatchKind { fabric, width } = kind;
        let fabric_at = |index: usize| &fabrics[index].fabric;
        let batch = match fabric {
            Some(fabric) => ClothBatch::new(Arc::clone(fabric_at(fabric)), width),
            None => ClothBatch::mixed(fabric_at(0)).expect("groups of fabrics are of grids"),
        };
        Self {
            batch,
            occupants: vec![None; width.get()],
            surfaces: vec![LaneSurface::default(); width.get()],
            bounds: Vec::new(),
            width,
            substeps: 0,
            joins: true,
            touches: false,
            covered: 0.0,
            time: Duration::ZERO,
        }
    }

    /// Whether the batch is of a kind, in a group of these fabrics.
    pub fn is_of(&self, kind: BatchKind, fabrics: &[FabricCount]) -> bool {
        self.width == kind.width
            && match kind.fabric {
                Some(fabric) => {
                    !self.batch.is_mixed()
                        && Arc::ptr_eq(self.batch.fabric(), &fabrics[fabric].fabric)
                }
                None => self.batch.is_mixed(),
            }
    }

    /// Whether another batch is of the same kind.
    pub fn is_like(&self, other: &Self) -> bool {
        let mixed = [self, other].map(|batch| batch.batch.is_mixed());
        self.width == other.width
            && mixed[0] == mixed[1]
            && (mixed[0] || Arc::ptr_eq(self.batch.fabric(), other.batch.fabric()))
    }

    /// The occupied lanes and their cloths.
    pub fn occupied(&self) -> impl Iterator<Item = (usize, Occupant)> + '_ {
        let lanes = self.occupants.iter().enumerate();
        lanes.filter_map(|(lane, occupant)| Some((lane, (*occupant)?)))
    }

    /// Number of occupied lanes.
    pub fn occupied_count(&self) -> usize {
        self.occupants.iter().flatten().count()
    }

    /// Fills free lanes with those pending cloths that may be in the batch, as long as there are any of both, calls
    /// `assigned` with each cloth and its lane, and clears lanes whose cloths were removed.
    pub fn fill(
        &mut self,
        pending: &mut Vec<PendingCloth>,
        fabrics: &[FabricCount],
        mut assigned: impl FnMut(Entity, usize),
    ) {
        let fabric_of = |cloth: &PendingCloth| &fabrics[cloth.fabric].fabric;
        let (mixed, own) = (self.batch.is_mixed(), Arc::clone(self.batch.fabric()));
        let mut fitting =
            pending.extract_if(.., |cloth| mixed || Arc::ptr_eq(fabric_of(cloth), &own));
        let free = (0..self.occupants.len()).filter(|&lane| self.occupants[lane].is_none());
        let entering: Vec<(usize, PendingCloth)> =
            free.map_while(|lane| Some((lane, fitting.next()?))).collect();
        drop(fitting);
        for (lane, PendingCloth { entity, fabric, material, .. }) in &entering {
            let occupant = Occupant { entity: *entity, fabric: *fabric, material: *material };
            self.occupants[*lane] = Some(occupant);
            assigned(*entity, *lane);
        }
        let is_left =
            |lane: &usize| self.occupants[*lane].is_none() && self.batch.is_occupied(*lane);
        let leaving: Vec<usize> = (0..self.occupants.len()).filter(is_left).collect();
        let entering = entering.iter().map(|(lane, cloth)| Entering {
            lane: *lane,
            fabric: fabric_of(cloth),
            snapshot: &cloth.snapshot,
            material: cloth.material,
        });
        let entering: Vec<Entering> = entering.collect();
        if !leaving.is_empty() || !entering.is_empty() {
            self.batch.exchange(&leaving, &entering).expect("pending cloths are valid");
        }
    }

    /// Frees all lanes and adds their cloths to the pending ones.
    pub fn dissolve(&mut self, pending: &mut Vec<PendingCloth>) {
        self.take_out(pending, |_| true);
        self.fill(&mut Vec::new(), &[], |_, _| {});
    }

    /// Frees the lanes of those cloths whose fabrics, by their index in the group, leave; they wait for other lanes.
    pub fn take_out(
        &mut self,
        pending: &mut Vec<PendingCloth>,
        mut leaves: impl FnMut(usize) -> bool,
    ) {
        for (lane, occupant) in self.occupants.iter_mut().enumerate() {
            let leaving = occupant.take_if(|occupant| leaves(occupant.fabric));
            if let Some(Occupant { entity, fabric, material }) = leaving {
                let snapshot = self.batch.snapshot(lane);
                pending.push(PendingCloth { entity, fabric, snapshot, material });
            }
        }
    }
}

/// Write access to one cloth in its batch.
pub(crate) struct LaneMut<'a> {
    pub occupied: &'a mut OccupiedBatch,
    pub lane: usize,
}

impl LaneMut<'_> {
    /// Sets frame motion, gravity and wind of the next tick. If a number is not finite, as when the motion
    /// between two finite poses overflows, nothing acts on the cloth.
    pub fn drive(&mut self, drive: Drive) {
        let batch = &mut self.occupied.batch;
        if batch.drive(self.lane, drive).is_err() {
            batch.drive(self.lane, Drive::NONE).expect("an occupied lane");
        }
    }

    /// Moves pins of the cloth in the next tick. None moves if a position is not finite.
    pub fn move_pins(&mut self, pins: Vec<MovingPin>) {
        let _ = self.occupied.batch.move_pins(self.lane, pins);
    }

    /// Sets the guides of the cloth in the next tick; without any, the cloth is free. They stay as they are if a number is
    /// not finite.
    pub fn set_guides(&mut self, guides: Vec<Guide>) {
        let _ = self.occupied.batch.set_guides(self.lane, guides);
    }

    /// Sets the wind at each particle of the cloth less that of its drive, m/s. It stays as it is if a number is not finite.
    pub fn set_local_wind(&mut self, winds: Vec<Vec3>) {
        let _ = self.occupied.batch.set_local_wind(self.lane, winds);
    }

    /// Holds particles of the cloth. None is held if a number is not finite.
    pub fn hold(&mut self, holds: Vec<Hold>) {
        let batch = &mut self.occupied.batch;
        if batch.hold(self.lane, holds).is_err() {
            batch.hold(self.lane, Vec::new()).expect("an occupied lane");
        }
    }

    /// Reports what the cloth does to its pins in the next ticks, or ceases to.
    pub fn report_pins(&mut self, groups: Option<(&Arc<PinGroups>, Vec<[Vec3; 2]>)>) {
        self.occupied.batch.report_pins(self.lane, groups).expect("an occupied lane");
    }

    /// Sets the velocities of the pins at the end of the last tick, m/s, of a cloth that is new in its lane.
    pub fn set_pin_velocities(&mut self, velocities: Vec<Vec3>) {
        let batch = &mut self.occupied.batch;
        batch.set_pin_velocities(self.lane, velocities).expect("an occupied lane");
    }

    /// Sets the shapes that the cloth may touch in the next tick. Shapes with numbers that are not finite are
    /// ignored.
    pub fn set_colliders(&mut self, colliders: impl IntoIterator<Item = Collider>) {
        let _ = self.occupied.batch.set_colliders(self.lane, colliders);
    }

    /// Keeps the cloth from passing through itself, or lets it. Settings that are not valid let it.
    pub fn set_self_collision(&mut self, settings: Option<SelfCollision>) {
        let batch = &mut self.occupied.batch;
        if batch.set_self_collision(self.lane, settings).is_err() {
            batch.set_self_collision(self.lane, None).expect("an occupied lane");
        }
    }

    /// Gives the cloth air inside, or takes it away.
    ///
    /// # Errors
    ///
    /// A number cannot be, or the air of an open cloth would be sealed. The cloth keeps its air.
    pub fn set_pressure(&mut self, air: Option<Pressure>) -> Result<(), BatchError> {
        self.occupied.batch.set_pressure(self.lane, air)
    }

    /// Sews the cloth together, as far as lacings say. It stays as it is if they cannot be.
    pub fn sew(&mut self, seams: &Arc<Seams>, lacings: Vec<Lacing>) {
        let _ = self.occupied.batch.sew(self.lane, seams, lacings);
    }

    /// Opens all seams of the cloth.
    pub fn unsew(&mut self) {
        self.occupied.batch.unsew(self.lane).expect("an occupied lane");
    }

    /// Changes the material, which must be valid.
    pub fn set_material(&mut self, material: FabricMaterial) {
        if self.occupied.batch.set_material(self.lane, material).is_ok()
            && let Some(occupant) = &mut self.occupied.occupants[self.lane]
        {
            occupant.material = material;
        }
    }

    /// The state of the cloth.
    pub fn snapshot(&self) -> ClothSnapshot {
        self.occupied.batch.snapshot(self.lane)
    }

    /// Overwrites the state of the cloth.
    ///
    /// # Panics
    ///
    /// If the state is not finite, or of another fabric.
    pub fn restore(&mut self, state: &ClothSnapshot) {
        self.occupied.batch.restore(self.lane, state).expect("a finite state of the same fabric");
    }
}
