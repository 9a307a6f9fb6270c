//! Tethers of packs of particles.

use glam::Vec3;

use crate::fabric::Fabric;
use crate::lanes::Pack;
use crate::seating::Seating;
use crate::vector::{Pack3, set_lane3, splat3};

/// For each pack of particles, where the pins are to which they are tethered.
#[derive(Clone, Debug)]
pub(crate) struct PackedTethers<P: Pack> {
    /// Positions, m.
    pub pins: Vec<Pack3<P>>,
    /// Lengths at rest, m; infinite where there is no tether.
    pub lengths: Vec<P>,
    /// The seats of particles, and the pins to which they are tethered.
    seats: Vec<((usize, usize), u32)>,
}

impl<P: Pack> PackedTethers<P> {
    pub fn of(fabric: &Fabric) -> Self {
        let seating = Seating::of::<P, P>(fabric);
        let packs = seating.parts().len();
        let mut lengths = vec![P::splat(f32::INFINITY); packs];
        let mut seats = Vec::new();
        for tether in fabric.tethers() {
            let (pack, lane) = seating.seat(tether.particle as usize, 0);
            lengths[pack].lanes_mut()[lane] = tether.length;
            seats.push(((pack, lane), tether.pin));
        }
        Self { pins: vec![splat3(Vec3::ZERO); packs], lengths, seats }
    }

    /// Pins stay where they are until the cloth's state is overwritten.
    pub fn set_pins(&mut self, positions: &[Vec3]) {
        for &((pack, lane), pin) in &self.seats {
            set_lane3(&mut self.pins[pack], lane, positions[pin as usize]);
        }
    }
}
