//! Numbers of the fabric for a pack of particles: one for all lanes, or one for each lane.
//!
//! Where cloths of one fabric lie side by side, a pack holds the same particle of each, so that its area is
//! one `f32`. Where their fabrics differ, each lane has its own area, [`PerLane`]. Where one cloth lies across the
//! lanes, a pack holds several of its particles, and each lane has its own area, too.

use core::fmt::Debug;

use crate::simd::lane::{Lane, Pack};
use crate::simd::vec3::V3;

/// Number of partial sums in which a sum over all particles is computed. All widths and layouts must give the
/// same bits: a cloth across eight lanes has one partial sum in each lane, so every other layout keeps eight
/// partial sums.
pub(crate) const PARTIAL_SUMS: usize = 8;

/// A number of the fabric for a pack.
pub(crate) trait Constant<P: Pack>: Copy + Debug + Send + Sync + 'static {
    /// The number, from a value for each lane of one cloth.
    fn of(lanes: impl Fn(usize) -> f32) -> Self;

    /// Whether the number is known to be zero in all lanes, so that the pack can be skipped.
    fn is_zero(self) -> bool;

    /// The number in all lanes.
    fn pack(self) -> P;

    /// The number in a register.
    fn load<L: Lane<Pack = P>>(&self, token: L::Token) -> L;

    /// `new` in lanes where the number is positive, `old` in the others. Call it only for numbers that are
    /// not [`is_zero`](Self::is_zero).
    fn select<L: Lane<Pack = P>>(&self, token: L::Token, new: L, old: L) -> L;

    /// [`select`](Self::select) for vectors.
    #[inline(always)]
    fn select3<L: Lane<Pack = P>>(&self, token: L::Token, new: V3<L>, old: V3<L>) -> V3<L> {
        V3 {
            x: self.select(token, new.x, old.x),
            y: self.select(token, new.y, old.y),
            z: self.select(token, new.z, old.z),
        }
    }

    /// The sum over all particles of each cloth, in all of the cloth's lanes, from the partial sums.
    fn total<L: Lane<Pack = P>>(token: L::Token, partial: [L; PARTIAL_SUMS]) -> L;
}

/// One number for all lanes: cloths side by side.
impl<P: Pack> Constant<P> for f32 {
    fn of(lanes: impl Fn(usize) -> f32) -> Self {
        lanes(0)
    }

    #[inline(always)]
    fn is_zero(self) -> bool {
        self == 0.0
    }

    fn pack(self) -> P {
        P::splat(self)
    }

    #[inline(always)]
    fn load<L: Lane<Pack = P>>(&self, token: L::Token) -> L {
        L::splat(token, *self)
    }

    #[inline(always)]
    fn select<L: Lane<Pack = P>>(&self, _: L::Token, new: L, _: L) -> L {
        new
    }

    #[inline(always)]
    fn total<L: Lane<Pack = P>>(_: L::Token, [first, rest @ ..]: [L; PARTIAL_SUMS]) -> L {
        let mut total = first;
        for partial in rest {
            total = total + partial;
        }
        total
    }
}

/// One number for each lane: cloths of different fabrics side by side. Each lane is computed as by an `f32`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PerLane<P>(pub P);

impl<P: Pack> PerLane<P> {
    /// The same number in all lanes.
    pub fn splat(value: f32) -> Self {
        Self(P::splat(value))
    }

    /// Overwrites the number of one lane.
    pub fn set_lane(&mut self, lane: usize, value: f32) {
        self.0.lanes_mut()[lane] = value;
    }
}

impl<P: Pack> Constant<P> for PerLane<P> {
    fn of(lanes: impl Fn(usize) -> f32) -> Self {
        Self(<P as Constant<P>>::of(lanes))
    }

    /// Zero in one lane is zero in all: only the inverse masses of pins are, and the fabrics have the same pins.
    #[inline(always)]
    fn is_zero(self) -> bool {
        self.0.lanes()[0] == 0.0
    }

    fn pack(self) -> P {
        self.0
    }

    #[inline(always)]
    fn load<L: Lane<Pack = P>>(&self, token: L::Token) -> L {
        L::load(token, &self.0)
    }

    #[inline(always)]
    fn select<L: Lane<Pack = P>>(&self, _: L::Token, new: L, _: L) -> L {
        new
    }

    #[inline(always)]
    fn total<L: Lane<Pack = P>>(token: L::Token, partial: [L; PARTIAL_SUMS]) -> L {
        <f32 as Constant<P>>::total(token, partial)
    }
}

/// One number for each lane: a single cloth across the lanes.
impl<P: Pack> Constant<Self> for P {
    fn of(lanes: impl Fn(usize) -> f32) -> Self {
        let mut pack = Self::splat(0.0);
        for (lane, value) in pack.lanes_mut().iter_mut().enumerate() {
            *value = lanes(lane);
        }
        pack
    }

    #[inline(always)]
    fn is_zero(self) -> bool {
        false
    }

    fn pack(self) -> Self {
        self
    }

    #[inline(always)]
    fn load<L: Lane<Pack = Self>>(&self, token: L::Token) -> L {
        L::load(token, self)
    }

    #[inline(always)]
    fn select<L: Lane<Pack = Self>>(&self, token: L::Token, new: L, old: L) -> L {
        new.or_where_not(L::splat(token, 0.0).lt(L::load(token, self)), old)
    }

    /// The lanes of the first partial sum are the partial sums of the cloth.
    #[inline(always)]
    fn total<L: Lane<Pack = Self>>(token: L::Token, [only, ..]: [L; PARTIAL_SUMS]) -> L {
        let mut lanes = Self::splat(0.0);
        only.store(&mut lanes);
        let [first, rest @ ..] = lanes.lanes() else { return only };
        let mut total = *first;
        for partial in rest {
            total += partial;
        }
        L::splat(token, total)
    }
}
