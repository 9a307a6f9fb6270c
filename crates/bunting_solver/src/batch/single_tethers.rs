//! Tethers of a cloth that lies across the lanes, in packs of consecutive particles.

use glam::Vec3;

use crate::batch::tether_pack::TetherPack;
use crate::fabric::Tether;
use crate::simd::lane::Pack;
use crate::simd::vec3::set_lane3;

/// Tethers in the order of their packs.
#[derive(Clone, Debug)]
pub(crate) struct TetherPacks<P: Pack> {
    pub packs: Vec<TetherPack<P>>,
    /// For each tether of the fabric: its index among the packs, its lane, and its pin.
    pins: Vec<(usize, usize, u32)>,
}

impl<P: Pack> TetherPacks<P> {
    /// Tethers without the positions of their pins. `locate` gives a particle's pack and lane, `start` the number by
    /// which constraints find a pack.
    pub fn new(
        tethers: &[Tether],
        locate: impl Fn(u32) -> (usize, usize),
        start: impl Fn(usize) -> u32,
    ) -> Self {
        let mut occupied: Vec<usize> =
            tethers.iter().map(|tether| locate(tether.particle).0).collect();
        occupied.sort_unstable();
        occupied.dedup();
        let empty = |&pack: &usize| TetherPack::empty(start(pack));
        let mut packs: Vec<TetherPack<P>> = occupied.iter().map(empty).collect();
        let mut pins = Vec::new();
        for tether in tethers {
            let (pack, lane) = locate(tether.particle);
            let index = occupied.partition_point(|&other| other < pack);
            packs[index].lengths.lanes_mut()[lane] = tether.length;
            pins.push((index, lane, tether.pin));
        }
        Self { packs, pins }
    }

    /// Updates the positions of the pins, given the positions of all particles, m. Pins keep them until the
    /// cloth's state is overwritten.
    pub fn set_pins(&mut self, positions: &[Vec3]) {
        for &(index, lane, pin) in &self.pins {
            set_lane3(&mut self.packs[index].pins, lane, positions[pin as usize]);
        }
    }
}
