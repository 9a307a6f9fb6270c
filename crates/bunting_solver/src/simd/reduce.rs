//! Sums over all particles of each cloth.

use crate::batch::places::Constant;
use crate::simd::lane::Lane;
use crate::simd::vec3::V3;

/// In how many parts sums over all particles are taken, by their columns: a cloth that fills the lanes
/// has one in each of them, and must come to the bits of one that lies in a single lane.
pub(crate) const PARTS: usize = 8;

/// A sum over all particles, in parts.
pub(crate) struct Sum<L>([L; PARTS]);

impl<L: Lane> Sum<L> {
    #[inline(always)]
    pub fn new(token: L::Token) -> Self {
        Self([L::splat(token, 0.0); PARTS])
    }

    /// Adds what a pack has to its part.
    #[inline(always)]
    pub fn add(&mut self, part: u8, term: L) {
        let sum = &mut self.0[part as usize % PARTS];
        *sum = *sum + term;
    }

    /// Adds a product to a part.
    #[inline(always)]
    pub fn add_product(&mut self, part: u8, a: L, b: L) {
        let sum = &mut self.0[part as usize % PARTS];
        *sum = sum.plus_product(a, b);
    }

    #[inline(always)]
    pub fn total<C: Constant<L::Pack>>(self, token: L::Token) -> L {
        C::total(token, self.0)
    }
}

impl<L: Lane> V3<Sum<L>> {
    #[inline(always)]
    pub fn sums(token: L::Token) -> Self {
        Self { x: Sum::new(token), y: Sum::new(token), z: Sum::new(token) }
    }

    /// Adds what a pack has to its part.
    #[inline(always)]
    pub fn add_term(&mut self, part: u8, term: V3<L>) {
        self.x.add(part, term.x);
        self.y.add(part, term.y);
        self.z.add(part, term.z);
    }

    #[inline(always)]
    pub fn total<C: Constant<L::Pack>>(self, token: L::Token) -> V3<L> {
        V3 { x: self.x.total::<C>(token), y: self.y.total::<C>(token), z: self.z.total::<C>(token) }
    }
}
