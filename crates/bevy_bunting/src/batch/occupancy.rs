//! A batch, and whose lanes they are.

use std::sync::Arc;
use std::time::Duration;

use bevy_ecs::prelude::*;
use bunting_solver::{ClothBatch, ClothSnapshot, Fabric, FabricMaterial, LaneCount, LaneSurface};

/// A cloth that takes a lane.
#[derive(Debug)]
pub(crate) struct Newcomer {
    pub entity: Entity,
    pub snapshot: ClothSnapshot,
    pub material: FabricMaterial,
}

/// Who sits in a lane, and what they are made of.
pub(crate) type Seat = (Entity, FabricMaterial);

/// A batch, and whose lanes they are.
#[derive(Debug)]
pub(crate) struct Seats {
    pub batch: ClothBatch,
    pub entities: Vec<Option<Seat>>,
    /// What the lanes show, on its way to those who sit there.
    pub surfaces: Vec<LaneSurface>,
    pub lanes: LaneCount,
    /// Substeps in this tick.
    pub substeps: u32,
    pub joins: bool,
    /// Time that its phases have taken in this tick, where that is measured.
    pub time: Duration,
}

impl Seats {
    pub fn new(fabric: &Arc<Fabric>, lanes: LaneCount) -> Self {
        Self {
            batch: ClothBatch::new(Arc::clone(fabric), lanes),
            entities: vec![None; lanes.get()],
            surfaces: vec![LaneSurface::default(); lanes.get()],
            lanes,
            substeps: 0,
            joins: true,
            time: Duration::ZERO,
        }
    }

    pub fn particles(&self) -> usize {
        self.batch.fabric().particle_count() * self.batch.lane_count()
    }

    /// The lanes that are taken, and by whom.
    pub fn taken(&self) -> impl Iterator<Item = (usize, Seat)> + '_ {
        self.entities.iter().enumerate().filter_map(|(lane, seat)| Some((lane, (*seat)?)))
    }

    pub fn occupancy(&self) -> usize {
        self.entities.iter().flatten().count()
    }

    /// Seats newcomers as long as there is room, tells the lane of each, and lets no one ride on in a lane
    /// whose cloth was taken out.
    pub fn seat(
        &mut self,
        newcomers: &mut impl Iterator<Item = Newcomer>,
        mut moved: impl FnMut(Entity, usize),
    ) {
        let free = (0..self.entities.len()).filter(|&lane| self.entities[lane].is_none());
        let come: Vec<(usize, Newcomer)> = free.zip(newcomers).collect();
        for (lane, newcomer) in &come {
            self.entities[*lane] = Some((newcomer.entity, newcomer.material));
            moved(newcomer.entity, *lane);
        }
        let left = |lane: &usize| self.entities[*lane].is_none() && self.batch.is_occupied(*lane);
        let leave: Vec<usize> = (0..self.entities.len()).filter(left).collect();
        let come: Vec<_> = come
            .iter()
            .map(|(lane, newcomer)| (*lane, &newcomer.snapshot, newcomer.material))
            .collect();
        if !leave.is_empty() || !come.is_empty() {
            self.batch.exchange(&leave, &come).expect("only valid cloths are seated");
        }
    }

    /// Takes everyone out.
    pub fn dissolve(&mut self, into: &mut Vec<Newcomer>) {
        for (lane, seat) in self.entities.iter_mut().enumerate() {
            if let Some((entity, material)) = seat.take() {
                into.push(Newcomer { entity, snapshot: self.batch.snapshot(lane), material });
            }
        }
        self.seat(&mut core::iter::empty(), |_, _| {});
    }
}
