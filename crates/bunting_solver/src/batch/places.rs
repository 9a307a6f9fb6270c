//! Where a kernel finds particles, and what the fabric says of them.
//!
//! The lanes hold cloths of one fabric, or yarns of one cloth (`weave/`). What the fabric says is in the
//! first case the same in all lanes, and in the second each lane's own.

use core::fmt::Debug;
use core::ops::Range;

use crate::simd::lane::{Lane, Pack};
use crate::simd::reduce::PARTS;
use crate::simd::vec3::{Pack3, V3};

/// A number that belongs to the fabric.
pub(crate) trait Constant<P: Pack>: Copy + Debug + Send + Sync + 'static {
    /// How many particles of one cloth lie side by side.
    const SIDE: usize;

    /// The number in each of the lanes that lie side by side.
    fn of(lanes: impl Fn(usize) -> f32) -> Self;

    /// Whether it is zero, in all lanes.
    fn is_zero(self) -> bool;

    fn load<L: Lane<Pack = P>>(&self, token: L::Token) -> L;

    /// `new` in lanes where it is not zero, `old` in others; asked only where it is not zero in all.
    fn choose<L: Lane<Pack = P>>(&self, token: L::Token, new: L, old: L) -> L;

    /// A sum over all particles of each cloth, given those of its parts.
    fn total<L: Lane<Pack = P>>(token: L::Token, parts: [L; PARTS]) -> L;

    /// [`choose`](Self::choose), for vectors.
    #[inline(always)]
    fn choose3<L: Lane<Pack = P>>(&self, token: L::Token, new: V3<L>, old: V3<L>) -> V3<L> {
        V3 {
            x: self.choose(token, new.x, old.x),
            y: self.choose(token, new.y, old.y),
            z: self.choose(token, new.z, old.z),
        }
    }

    /// The lanes of a cloth.
    fn lanes(cloth: usize) -> Range<usize> {
        cloth..cloth + Self::SIDE
    }
}

/// The same in all lanes.
impl<P: Pack> Constant<P> for f32 {
    const SIDE: usize = 1;

    fn of(lanes: impl Fn(usize) -> f32) -> Self {
        lanes(0)
    }

    #[inline(always)]
    fn is_zero(self) -> bool {
        self == 0.0
    }

    #[inline(always)]
    fn choose<L: Lane<Pack = P>>(&self, _: L::Token, new: L, _: L) -> L {
        new
    }

    #[inline(always)]
    fn total<L: Lane<Pack = P>>(_: L::Token, [first, parts @ ..]: [L; PARTS]) -> L {
        let mut total = first;
        for part in parts {
            total = total + part;
        }
        total
    }

    #[inline(always)]
    fn load<L: Lane<Pack = P>>(&self, token: L::Token) -> L {
        L::splat(token, *self)
    }
}

/// Each lane's own.
impl<P: Pack> Constant<Self> for P {
    const SIDE: usize = Self::WIDTH;

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

    #[inline(always)]
    fn choose<L: Lane<Pack = Self>>(&self, token: L::Token, new: L, old: L) -> L {
        new.or_where_not(L::splat(token, 0.0).lt(L::load(token, self)), old)
    }

    #[inline(always)]
    fn total<L: Lane<Pack = Self>>(token: L::Token, [only, ..]: [L; PARTS]) -> L {
        let mut lanes = Self::splat(0.0);
        only.store(&mut lanes);
        let [first, parts @ ..] = lanes.lanes() else { return only };
        let mut total = *first;
        for part in parts {
            total += part;
        }
        L::splat(token, total)
    }

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
    weights: &'a [P],
    position: &'a mut [Pack3<P>],
}

impl<'a, P: Pack> Cloths<'a, P> {
    pub fn new(weights: &'a [P], position: &'a mut [Pack3<P>]) -> Self {
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
        L::load(token, &self.weights[at as usize])
    }

    #[inline(always)]
    fn one<L: Lane<Pack = P>>(&self, token: L::Token, _: u32) -> L {
        L::splat(token, 1.0)
    }
}
