//! Tethers in lanes, each to a pin of its own.

use glam::Vec3;

use crate::batch::layout::{PackedTether, Particles};
use crate::simd::lane::{Lane, Pack};
use crate::simd::vec3::{Pack3, V3, splat3};

/// A tether in each lane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TetherPack<P: Pack> {
    /// Where the tethered particle of each cloth is, or the first one of a single cloth.
    pub first: u32,
    /// Positions of the pins, m.
    pub pins: Pack3<P>,
    /// Lengths at rest, m; infinite in lanes without a tether.
    pub lengths: P,
}

impl<P: Pack> TetherPack<P> {
    /// No tether in any lane.
    pub fn empty(first: u32) -> Self {
        Self { first, pins: splat3(Vec3::ZERO), lengths: P::splat(f32::INFINITY) }
    }
}

impl<P: Pack> PackedTether<P> for TetherPack<P> {
    #[inline(always)]
    fn particle(&self) -> u32 {
        self.first
    }

    #[inline(always)]
    fn pin<L: Lane<Pack = P>, S: Particles<P>>(&self, token: L::Token, _: &S) -> V3<L> {
        V3::load(token, &self.pins)
    }

    #[inline(always)]
    fn length<L: Lane<Pack = P>>(&self, token: L::Token) -> L {
        L::load(token, &self.lengths)
    }
}
