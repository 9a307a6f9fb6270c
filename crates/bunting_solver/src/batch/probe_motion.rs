//! The motion of all cloths of a batch in a tick, by which their effort is chosen: see [`Loads::of_motion`].

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Positions};
use crate::fabric::Probe;
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::{Pack3, V3, lane3, splat3};
use crate::step::effort::Loads;

/// The ends of the probes when the tick began.
#[derive(Clone, Debug)]
pub(crate) struct ProbeMotion<P> {
    /// Positions of both ends of each probe, m.
    starts: Vec<[[P; 3]; 2]>,
    /// Length of the tick, s.
    tick: f32,
}

impl<P> Default for ProbeMotion<P> {
    fn default() -> Self {
        Self { starts: Vec::new(), tick: 0.0 }
    }
}

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Notes the ends of the probes at the beginning of a tick of `tick` seconds.
    pub fn note_probes(&mut self, tick: f32) {
        let mut starts = core::mem::take(&mut self.probe_motion.starts);
        starts.clear();
        starts.extend(self.fabric.probes().iter().map(|probe| self.ends(probe)));
        self.probe_motion = ProbeMotion { starts, tick };
    }

    /// Positions of both ends of a probe, m. Those of a single cloth are in every lane.
    fn ends(&self, probe: &Probe) -> [Pack3<P>; 2] {
        probe.particles.map(|particle| {
            let (pack, lane) = self.layout.locate(particle as usize, 0);
            let positions = self.positions.packs()[pack];
            if Y::CLOTHS == 1 { splat3(lane3(&positions, lane)) } else { positions }
        })
    }

    /// Acceleration of the links of each lane's cloth that have turned since the tick began, m/s². The sums have the
    /// order and the operations of [`Loads::of_motion`], so that the bits are the same.
    pub fn motion_loads(&self) -> impl Iterator<Item = f32> + '_ {
        let (mut turns, mut ways) = (P::splat(0.0), P::splat(0.0));
        let ProbeMotion { starts, tick } = &self.probe_motion;
        for (index, (probe, start)) in self.fabric.probes().iter().zip(starts).enumerate() {
            let mut scale = P::splat(probe.inverse_length_squared);
            if Y::FABRICS > 1 {
                for (lane, scale) in scale.lanes_mut().iter_mut().enumerate() {
                    *scale = self.fabric_of(lane).fabric.probes()[index].inverse_length_squared;
                }
            }
            let ends = &self.ends(probe);
            P::run(AddMotion { start, ends, scale, turns: &mut turns, ways: &mut ways });
        }
        (0..self.lanes.len()).map(move |cloth| {
            let fabric = &self.fabric_of(cloth).fabric;
            Loads::of_probes(fabric, turns.lanes()[cloth], ways.lanes()[cloth], *tick)
        })
    }
}

/// Adds the squared turn of a probe times a scale, and the squared way of its first end, in each lane. Products are not
/// fused with sums, as they are not in [`Loads::of_motion`].
struct AddMotion<'a, P> {
    start: &'a [Pack3<P>; 2],
    ends: &'a [Pack3<P>; 2],
    scale: P,
    turns: &'a mut P,
    ways: &'a mut P,
}

impl<P: Pack> Kernel<P> for AddMotion<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let from = V3::<L>::load(token, &self.ends[0]) - V3::load(token, &self.start[0]);
        let to = V3::<L>::load(token, &self.ends[1]) - V3::load(token, &self.start[1]);
        let turn = to - from;
        let squared_turn = turn.x * turn.x + turn.y * turn.y + turn.z * turn.z;
        let squared_way = from.x * from.x + from.y * from.y + from.z * from.z;
        let turns = L::load(token, self.turns) + squared_turn * L::load(token, &self.scale);
        turns.store(self.turns);
        (L::load(token, self.ways) + squared_way).store(self.ways);
    }
}
