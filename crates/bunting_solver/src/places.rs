//! Where a kernel finds particles, and what the fabric says of them.
//!
//! The lanes hold cloths of one fabric, or yarns of one cloth (`weave/`). What the fabric says is in the
//! first case the same in all lanes, and in the second each lane's own.

use crate::lanes::{Lane, Pack, Pack8};
use crate::vector::{Pack3, V3};

/// A number that belongs to the fabric.
pub(crate) trait Constant<P: Pack>: Copy {
    fn load<L: Lane<Pack = P>>(&self, token: L::Token) -> L;
}

/// The same in all lanes.
impl<P: Pack> Constant<P> for f32 {
    #[inline(always)]
    fn load<L: Lane<Pack = P>>(&self, token: L::Token) -> L {
        L::splat(token, *self)
    }
}

/// Each lane's own.
impl Constant<Self> for Pack8 {
    #[inline(always)]
    fn load<L: Lane<Pack = Self>>(&self, token: L::Token) -> L {
        L::load(token, self)
    }
}

/// The particles of cloths, or of yarns, one in each lane.
pub(crate) trait Places<P: Pack> {
    /// What there is one of for each link.
    type Constant: Constant<P>;

    fn position<L: Lane<Pack = P>>(&self, token: L::Token, at: u32) -> V3<L>;

    fn set_position<L: Lane<Pack = P>>(&mut self, at: u32, position: V3<L>);

    /// One over the particles' inertia, in units of the density, 1/m²; zero where they are pinned.
    fn weight<L: Lane<Pack = P>>(&self, token: L::Token, at: u32) -> L;

    /// One, but zero in lanes that have no link where others have one of this class.
    fn one<L: Lane<Pack = P>>(&self, token: L::Token, class: u32) -> L;
}

/// Cloths side by side.
pub(crate) struct Cloths<'a, P: Pack> {
    weights: &'a [f32],
    position: &'a mut [Pack3<P>],
}

impl<'a, P: Pack> Cloths<'a, P> {
    pub fn new(weights: &'a [f32], position: &'a mut [Pack3<P>]) -> Self {
        Self { weights, position }
    }
}

impl<P: Pack> Places<P> for Cloths<'_, P> {
    type Constant = f32;

    #[inline(always)]
    fn position<L: Lane<Pack = P>>(&self, token: L::Token, at: u32) -> V3<L> {
        V3::load(token, &self.position[at as usize])
    }

    #[inline(always)]
    fn set_position<L: Lane<Pack = P>>(&mut self, at: u32, position: V3<L>) {
        position.store(&mut self.position[at as usize]);
    }

    #[inline(always)]
    fn weight<L: Lane<Pack = P>>(&self, token: L::Token, at: u32) -> L {
        L::splat(token, self.weights[at as usize])
    }

    #[inline(always)]
    fn one<L: Lane<Pack = P>>(&self, token: L::Token, _: u32) -> L {
        L::splat(token, 1.0)
    }
}
