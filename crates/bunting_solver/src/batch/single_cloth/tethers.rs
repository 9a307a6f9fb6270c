//! Tethers of packs of particles.

use glam::Vec3;

use super::Sheets;
use crate::batch::layout::Seating;
use crate::fabric::{Fabric, Tether};
use crate::simd::lane::Pack;
use crate::simd::vec3::{Pack3, set_lane3, splat3};

/// Packs of particles with tethers, and where the pins are to which they are tethered.
#[derive(Clone, Debug)]
pub(crate) struct PackedTethers<P: Pack> {
    /// Where the packs begin.
    pub at: Vec<u32>,
    /// Positions of the pins, m.
    pub pins: Vec<Pack3<P>>,
    /// Lengths at rest, m; infinite where there is no tether.
    pub lengths: Vec<P>,
    /// The seats of tethers among these, and their pins.
    seats: Vec<((usize, usize), u32)>,
}

impl<P: Pack> PackedTethers<P> {
    pub fn of(fabric: &Fabric, tethers: &[Tether]) -> Self {
        let seating = Seating::of::<P, P>(fabric);
        let seat = |tether: &Tether| seating.seat(tether.particle as usize, 0);
        let mut packs: Vec<usize> = tethers.iter().map(|tether| seat(tether).0).collect();
        packs.sort_unstable();
        packs.dedup();
        let mut lengths = vec![P::splat(f32::INFINITY); packs.len()];
        let mut seats = Vec::new();
        for tether in tethers {
            let (pack, lane) = seat(tether);
            let index = packs.partition_point(|&other| other < pack);
            lengths[index].lanes_mut()[lane] = tether.length;
            seats.push(((index, lane), tether.pin));
        }
        Self {
            at: packs.iter().map(|&pack| Sheets::pack::<P>(pack)).collect(),
            pins: vec![splat3(Vec3::ZERO); packs.len()],
            lengths,
            seats,
        }
    }

    /// Pins stay where they are until the cloth's state is overwritten.
    pub fn set_pins(&mut self, positions: &[Vec3]) {
        for &((index, lane), pin) in &self.seats {
            set_lane3(&mut self.pins[index], lane, positions[pin as usize]);
        }
    }
}
