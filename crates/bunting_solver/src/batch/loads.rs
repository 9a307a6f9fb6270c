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

    /// The loads of each lane's cloth by the links that have turned since the tick began, and by tension. The sums have the
    /// order and the operations of [`Loads::of_motion`] and [`Loads::of_tension`], so that the bits are the same.
    pub fn probe_loads(&self) -> impl Iterator<Item = ProbeLoads> + '_ {
        let mut sums = ProbeSums::default();
        P::run(SumProbes { batch: self, sums: &mut sums });
        self.lanes.iter().enumerate().map(move |(cloth, state)| {
            let fabric = &self.fabric_of(cloth).fabric;
            let tick = self.probe_motion.tick;
            let of_cloth = |sum: &P| sum.lanes()[cloth];
            let (turns, displacements) = (of_cloth(&sums.turns), of_cloth(&sums.displacements));
            let strains = sums.strains.each_ref().map(of_cloth);
            let tension = |state: &LaneState| Loads::of_strains(fabric, &state.material, strains);
            ProbeLoads {
                motion: Loads::of_probes(fabric, turns, displacements, tick),
                tension: state.as_ref().map_or(0.0, tension),
            }
        })
    }

    /// Load of the colliders that pressed a cloth in this tick, m/s².
    pub fn contact_load(&self, cloth: usize, state: &LaneState) -> f32 {
        Loads::of_contacts(&self.fabric_of(cloth).fabric, state.pressing.mean())
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

/// Loads of a cloth that its probes tell, m/s².
pub(crate) struct ProbeLoads {
    pub motion: f32,
    pub tension: f32,
}

/// Sums over the probes in each lane.
struct ProbeSums<P> {
    /// Squared turns of the probes, rad².
    turns: P,
    /// Squared displacements of their first ends, m².
    displacements: P,
    /// Strains along warp and weft.
    strains: [P; 2],
}

impl<P: Pack> Default for ProbeSums<P> {
    fn default() -> Self {
        let zero = || P::splat(0.0);
        Self { turns: zero(), displacements: zero(), strains: [zero(), zero()] }
    }
}

/// Kernel that sums over the probes. Products are not fused with sums, as they are not in [`Loads::of_motion`].
struct SumProbes<'a, P: Pack, Y: Layout<P>> {
    batch: &'a LaneBatch<P, Y>,
    sums: &'a mut ProbeSums<P>,
}

impl<P: Pack, Y: Layout<P>> Kernel<P> for SumProbes<'_, P, Y> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let zero = L::splat(token, 0.0);
        let (mut turns, mut displacements, mut strains) = (zero, zero, [zero; 2]);
        let starts = &self.batch.probe_motion.starts;
        for (index, (probe, start)) in self.batch.fabric.probes().iter().zip(starts).enumerate() {
            let [first, second] = probe.particles;
            let ends = [first, second].map(|end| self.batch.end::<L>(token, end));
            let from = ends[0] - V3::load(token, &start[0]);
            let to = ends[1] - V3::load(token, &start[1]);
            let inverse_squared = self.batch.inverse_squared_length::<L>(token, index);
            turns = turns + squared(to - from) * inverse_squared;
            displacements = displacements + squared(from);
            let stretch = (squared(ends[1] - ends[0]) * inverse_squared).sqrt();
            let strain = &mut strains[usize::from(!probe.is_warp)];
            *strain = *strain + (stretch - L::splat(token, 1.0)).max(zero);
        }
        turns.store(&mut self.sums.turns);
        displacements.store(&mut self.sums.displacements);
        strains.into_iter().zip(&mut self.sums.strains).for_each(|(sum, to)| sum.store(to));
    }
}

/// The square of a vector's length, without fused products.
#[inline(always)]
fn squared<L: Lane>(of: V3<L>) -> L {
    of.x * of.x + of.y * of.y + of.z * of.z
}
