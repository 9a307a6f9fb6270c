//! Insertion and removal of cloths, and changes of their states.

use std::sync::Arc;

use glam::Vec3;

use crate::batch::lane_batch::{LaneBatch, without_minus_zero};
use crate::batch::lane_state::LaneState;
use crate::batch::layout::{Layout, OfCloth, Positions};
use crate::batch::single_cloth::SingleCloth;
use crate::batch::single_net::SingleNet;
use crate::batch::snapshot::{ClothSnapshot, SnapshotHistory};
use crate::fabric::{Fabric, FabricMaterial};
use crate::simd::lane::Pack;
use crate::simd::registers::Pack8;
use crate::simd::vec3::set_lane3;
use crate::stability::pin_strain::PinStrain;
use crate::step::bdf::IntegratorHistory;

/// A cloth on its way into a lane.
#[derive(Clone, Copy, Debug)]
pub struct Entering<'a> {
    /// The lane.
    pub lane: usize,
    /// The fabric that the cloth is cut from: the batch's own, or one of its topology where the batch is mixed.
    pub fabric: &'a Arc<Fabric>,
    /// The state of the cloth.
    pub snapshot: &'a ClothSnapshot,
    /// The material of the cloth.
    pub material: FabricMaterial,
}

/// One of the vectors of each particle, if the state has it.
type VectorsOf = fn(&ClothSnapshot) -> Option<&[Vec3]>;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Takes cloths out of lanes, and puts others in, whose fabrics are the batch's or have its topology.
    pub fn exchange(&mut self, leave: &[usize], come: &[Entering]) {
        // The state of an empty lane matters to no other and is left, unless it is not finite, which would
        // stay so and be slow.
        let rest = ClothSnapshot::at_rest(&self.fabric);
        let mut states = Vec::new();
        for &lane in leave {
            self.lanes[lane] = None;
            if !self.is_finite(lane) {
                states.push((lane, &rest));
            }
        }
        for &Entering { lane, fabric, snapshot, material } in come {
            self.set_fabric(lane, fabric);
            self.lanes[lane] = Some(LaneState::new(material));
            states.push((lane, snapshot));
        }
        self.restore(&states);
    }

    /// Overwrites the states of lanes, in one pass over each array. A cloth without a history continues with
    /// a substep of first order.
    pub fn restore(&mut self, states: &[(usize, &ClothSnapshot)]) {
        let positions: Vec<Vec<Vec3>> = states
            .iter()
            .map(|(_, state)| state.positions.iter().copied().map(without_minus_zero).collect())
            .collect();
        let of_cloths: Vec<OfCloth> =
            states.iter().zip(&positions).map(|(&(lane, _), at)| (lane, Some(&at[..]))).collect();
        // Formulas of first order multiply the history by zero, so that a lane without one may hold any
        // finite values.
        let counts = |&(lane, state): &(usize, &ClothSnapshot)| {
            state.history.is_some() || !self.is_finite(lane)
        };
        let with_history: Vec<_> = states.iter().copied().filter(counts).collect();
        self.layout.write(self.positions.packs_mut(), &of_cloths);
        self.write_vectors(states, &with_history);
        for (&(lane, state), positions) in states.iter().zip(&positions) {
            self.restore_lane(lane, state, positions);
        }
    }

    /// Writes velocities of some lanes, and the integrator's history of others.
    fn write_vectors(
        &mut self,
        states: &[(usize, &ClothSnapshot)],
        with_history: &[(usize, &ClothSnapshot)],
    ) {
        fn history(state: &ClothSnapshot) -> Option<&SnapshotHistory> {
            state.history.as_ref()
        }
        let arrays: [(_, &[_], VectorsOf); 5] = [
            (&mut self.velocity, states, |state| Some(&state.velocities)),
            (&mut self.displacement, with_history, |state| Some(&history(state)?.displacements[0])),
            (&mut self.older_displacement, with_history, |state| {
                Some(&history(state)?.displacements[1])
            }),
            (&mut self.older_velocity, with_history, |state| {
                Some(&history(state)?.older_velocities[0])
            }),
            (&mut self.oldest_velocity, with_history, |state| {
                Some(&history(state)?.older_velocities[1])
            }),
        ];
        for (packs, states, vectors) in arrays {
            let of_cloths: Vec<OfCloth> =
                states.iter().map(|&(lane, state)| (lane, vectors(state))).collect();
            self.layout.write(packs, &of_cloths);
        }
    }

    /// Restores the state of a lane besides its vectors.
    fn restore_lane(&mut self, lane: usize, state: &ClothSnapshot, positions: &[Vec3]) {
        let history = state.history.as_ref();
        self.set_relaxation(lane, history.map_or(&[], |history| &history.relaxation));
        // At the start of a tick the diagonals' targets are computed again in any case.
        if (1..self.clock.settings.substeps).contains(&self.clock.begun) {
            self.set_diagonals_at_rest(Y::lanes(lane));
        }
        for pin in self.fabric.pins() {
            let (pack, lane) = self.layout.locate(pin.particle as usize, lane);
            set_lane3(&mut self.velocity[pack], lane, Vec3::ZERO);
        }
        self.positions.clear();
        let fabric = &self.fabrics[Y::fabric_of(lane)].fabric;
        self.layout.set_pins(lane, fabric, positions);
        if let Some(cloth) = &mut self.lanes[lane] {
            cloth.history =
                history.map_or_else(IntegratorHistory::default, |history| history.integrator);
            cloth.are_pins_at_rest = fabric.are_pins_at_rest(positions);
            let pin_strain = PinStrain::of(fabric, positions);
            if cloth.pin_strain != pin_strain {
                cloth.pin_strain = pin_strain;
                cloth.added_mass = None;
            }
        }
    }
}

impl<P: Pack> LaneBatch<P, SingleCloth<P>> {
    /// An empty batch of one cloth across the lanes; none unless the fabric is a grid whose yarns run
    /// straight.
    pub fn single_cloth(fabric: &Arc<Fabric>) -> Option<Self> {
        let layout = SingleCloth::of(fabric)?;
        Some(Self::new(Arc::clone(fabric), layout))
    }
}

impl LaneBatch<Pack8, SingleNet> {
    /// An empty batch of one net across the lanes; none unless the fabric is one.
    pub fn single_net(fabric: &Arc<Fabric>) -> Option<Self> {
        let layout = SingleNet::of(fabric)?;
        Some(Self::new(Arc::clone(fabric), layout))
    }
}
