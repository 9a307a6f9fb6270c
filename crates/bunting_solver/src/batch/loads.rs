//! What moved, strained and pressed the cloths of a batch in a tick, by which their effort is chosen: see [`Loads`].

use glam::Vec3;

use crate::batch::lane_batch::LaneBatch;
use crate::batch::lane_state::LaneState;
use crate::batch::layout::{Layout, Positions};
use crate::batch::probe_motion::ProbeMotion;
use crate::fabric::Fabric;
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::{Pack3, V3, lane3, splat3};
use crate::step::loads::Loads;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Notes the ends of the probes at the beginning of a tick of `tick` seconds.
    pub fn note_probes(&mut self, tick: f32) {
        let mut starts = core::mem::take(&mut self.probe_motion.starts);
        starts.resize(self.fabric.probes().len(), [splat3(Vec3::ZERO); 2]);
        P::run(NoteProbes { batch: self, starts: &mut starts });
        self.probe_motion = ProbeMotion { starts, tick };
    }

    /// Position of the end of a probe, m. That of a single cloth is in every lane.
    #[inline(always)]
    fn end<L: Lane<Pack = P>>(&self, token: L::Token, particle: u32) -> V3<L> {
        let (pack, lane) = self.layout.locate(particle as usize, 0);
        let positions = &self.positions.packs()[pack];
        if Y::CLOTHS > 1 {
            return V3::load(token, positions);
        }
        let Vec3 { x, y, z } = lane3(positions, lane);
        V3 { x: L::splat(token, x), y: L::splat(token, y), z: L::splat(token, z) }
    }

    /// Inverse of the squared length of a probe in each lane, 1/m².
    #[inline(always)]
    fn inverse_squared_length<L: Lane<Pack = P>>(&self, token: L::Token, index: usize) -> L {
        let of_fabric = |fabric: &Fabric| fabric.probes()[index].inverse_length_squared;
        if Y::FABRICS == 1 {
            return L::splat(token, of_fabric(&self.fabric));
        }
        let mut lengths = P::splat(0.0);
        for (lane, length) in lengths.lanes_mut().iter_mut().enumerate() {
            *length = of_fabric(&self.fabric_of(lane).fabric);
        }
        L::load(token, &lengths)
    }

    /// Acceleration of the links of each lane's cloth that have turned since the tick began, m/s². The sums have the
    /// order and the operations of [`Loads::of_motion`], so that the bits are the same.
    pub fn motion_loads(&self) -> impl Iterator<Item = f32> + '_ {
        let (mut turns, mut displacements) = (P::splat(0.0), P::splat(0.0));
        P::run(SumMotion { batch: self, turns: &mut turns, displacements: &mut displacements });
        (0..self.lanes.len()).map(move |cloth| {
            let fabric = &self.fabric_of(cloth).fabric;
            let tick = self.probe_motion.tick;
            Loads::of_probes(fabric, turns.lanes()[cloth], displacements.lanes()[cloth], tick)
        })
    }

    /// Load of the pins that draw a cloth out, or of the air that draws it taut from inside, m/s².
    pub fn tension_load(&self, cloth: usize, state: &LaneState) -> f32 {
        let fabric = &self.fabric_of(cloth).fabric;
        let of_pins = Loads::of_pin_strain(fabric, &state.material, &state.pin_strain);
        of_pins.max(state.inner_air.as_ref().map_or(0.0, |inner| {
            inner.load(
                fabric,
                state.material.area_density,
                state.pressure_inside().unwrap_or_default(),
            )
        }))
    }

    /// Load of the colliders that pressed a cloth in this tick, or come near it, m/s².
    pub fn contact_load(&self, cloth: usize, state: &LaneState) -> f32 {
        let fabric = &self.fabric_of(cloth).fabric;
        let of_approach = Loads::of_approach(fabric, state.approach);
        Loads::of_contacts(fabric, state.pressing.mean()).max(of_approach)
    }
}

/// Kernel that copies the ends of the probes.
struct NoteProbes<'a, P: Pack, Y: Layout<P>> {
    batch: &'a LaneBatch<P, Y>,
    starts: &'a mut [[Pack3<P>; 2]],
}

impl<P: Pack, Y: Layout<P>> Kernel<P> for NoteProbes<'_, P, Y> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        for (start, probe) in self.starts.iter_mut().zip(self.batch.fabric.probes()) {
            for (start, particle) in start.iter_mut().zip(probe.particles) {
                self.batch.end::<L>(token, particle).store(start);
            }
        }
    }
}

/// Kernel that sums, in each lane, the squared turns of all probes times their inverse squared lengths, and the squared
/// displacements of their first ends. Products are not fused with sums, as they are not in [`Loads::of_motion`].
struct SumMotion<'a, P: Pack, Y: Layout<P>> {
    batch: &'a LaneBatch<P, Y>,
    turns: &'a mut P,
    displacements: &'a mut P,
}

impl<P: Pack, Y: Layout<P>> Kernel<P> for SumMotion<'_, P, Y> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let (mut turns, mut displacements) = (L::splat(token, 0.0), L::splat(token, 0.0));
        let starts = &self.batch.probe_motion.starts;
        for (index, (probe, start)) in self.batch.fabric.probes().iter().zip(starts).enumerate() {
            let [first, second] = probe.particles;
            let from = self.batch.end::<L>(token, first) - V3::load(token, &start[0]);
            let to = self.batch.end::<L>(token, second) - V3::load(token, &start[1]);
            let turn = to - from;
            let squared_turn = turn.x * turn.x + turn.y * turn.y + turn.z * turn.z;
            let squared_displacement = from.x * from.x + from.y * from.y + from.z * from.z;
            turns = turns + squared_turn * self.batch.inverse_squared_length::<L>(token, index);
            displacements = displacements + squared_displacement;
        }
        turns.store(self.turns);
        displacements.store(self.displacements);
    }
}
