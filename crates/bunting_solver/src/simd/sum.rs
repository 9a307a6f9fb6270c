//! Sums over all particles of each cloth.

use crate::simd::constant::{Constant, PARTIAL_SUMS};
use crate::simd::lane::Lane;
use crate::simd::vec3::V3;

/// A sum over all particles, as partial sums.
pub(crate) struct Sum<L>([L; PARTIAL_SUMS]);

impl<L: Lane> Sum<L> {
    /// Zero.
    #[inline(always)]
    pub fn new(token: L::Token) -> Self {
        Self([L::splat(token, 0.0); PARTIAL_SUMS])
    }

    /// Adds the term of a pack to the partial sum of the pack.
    #[inline(always)]
    pub fn add(&mut self, partial: u8, term: L) {
        let sum = &mut self.0[partial as usize % PARTIAL_SUMS];
        *sum = *sum + term;
    }

    /// Adds the product `a` × `b` to a partial sum, rounded once.
    #[inline(always)]
    pub fn add_product(&mut self, partial: u8, a: L, b: L) {
        let sum = &mut self.0[partial as usize % PARTIAL_SUMS];
        *sum = sum.plus_product(a, b);
    }

    /// The sum, in all lanes of the cloth.
    #[inline(always)]
    pub fn total<C: Constant<L::Pack>>(self, token: L::Token) -> L {
        C::total(token, self.0)
    }
}

impl<L: Lane> V3<Sum<L>> {
    /// Zero.
    #[inline(always)]
    pub fn sums(token: L::Token) -> Self {
        Self { x: Sum::new(token), y: Sum::new(token), z: Sum::new(token) }
    }

    /// Adds the term of a pack to the partial sum of the pack.
    #[inline(always)]
    pub fn add_term(&mut self, partial: u8, term: V3<L>) {
        self.x.add(partial, term.x);
        self.y.add(partial, term.y);
        self.z.add(partial, term.z);
    }

    /// The sum, in all lanes of the cloth.
    #[inline(always)]
    pub fn total<C: Constant<L::Pack>>(self, token: L::Token) -> V3<L> {
        V3 { x: self.x.total::<C>(token), y: self.y.total::<C>(token), z: self.z.total::<C>(token) }
    }
}
