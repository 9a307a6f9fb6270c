//! Lanes: the operations of a kernel on vectors of any width.
//!
//! A coordinate of a particle is stored in a [`Pack`], which has one float for each lane of the batch. A
//! kernel is written once over [`Lane`], the register that holds a pack, and runs at every width through
//! [`Pack::run`]. The widths themselves are in `registers.rs`.
//!
//! The only operations are `+ − × ÷ √`, a sum with a product, comparisons and selections. Each is correctly
//! rounded (IEEE 754), and none is estimated; a sum with a product is rounded once, in software if the
//! instruction set has no instruction for it. The bits of a lane therefore depend neither on the width, nor
//! on the instruction set, nor on the values in the other lanes.
//!
//! A kernel is compiled with the machine's instructions only as far as its calls are inlined. Therefore every
//! function that a kernel calls is `#[inline(always)]`. Closures cannot have this attribute, so kernels
//! contain none and use neither `map` nor `from_fn`.

use core::fmt::Debug;
use core::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Sub};

/// One float for each lane of a batch, in memory.
pub(crate) trait Pack: Copy + Debug + Send + Sync + 'static {
    /// Number of lanes.
    const WIDTH: usize;

    /// The same value in every lane.
    fn splat(value: f32) -> Self;

    /// The lanes, in order.
    fn lanes(&self) -> &[f32];

    /// The lanes, in order, for writing.
    fn lanes_mut(&mut self) -> &mut [f32];

    /// Runs a kernel with the best instructions that this machine has for this width.
    fn run<K: Kernel<Self>>(kernel: K);
}

/// A loop over packs, written once for every width.
pub(crate) trait Kernel<P: Pack> {
    /// Runs the loop. Must be `#[inline(always)]`, so that it is compiled for the caller's target features.
    fn run<L: Lane<Pack = P>>(self, token: L::Token);
}

/// The result of a comparison of two [`Lane`]s: a truth value for each lane.
pub(crate) trait Mask: Copy + BitAnd<Output = Self> + BitOr<Output = Self> {
    /// Whether any lane is true.
    fn any(self) -> bool;

    /// Whether all lanes are true.
    fn all(self) -> bool;

    /// One bit for each lane, that of the first lane the least.
    fn bits(self) -> u64;
}

/// One float for each lane of a batch, in a register.
pub(crate) trait Lane:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// The type of these floats in memory.
    type Pack: Pack;
    /// Proof that this machine has the instructions that the kernel is compiled for.
    type Token: Copy;
    /// The result of a comparison.
    type Mask: Mask;

    fn splat(token: Self::Token, value: f32) -> Self;
    fn load(token: Self::Token, pack: &Self::Pack) -> Self;
    fn store(self, pack: &mut Self::Pack);
    /// Loads consecutive floats from index `at` on, one for each lane.
    fn load_at(token: Self::Token, values: &[f32], at: usize) -> Self;
    /// Stores the lanes to consecutive floats from index `at` on.
    fn store_at(self, values: &mut [f32], at: usize);
    /// The first three numbers of the vectors with these indices, one vector in each lane.
    fn gather<V: Pack>(token: Self::Token, vectors: &[V], at: &[u32]) -> [Self; 3];
    /// Overwrites the vectors with these indices by those of the lanes, and by zero behind the third number.
    fn scatter<V: Pack>(token: Self::Token, lanes: [Self; 3], vectors: &mut [V], at: &[u32]);
    fn sqrt(self) -> Self;
    fn abs(self) -> Self;
    fn lt(self, other: Self) -> Self::Mask;
    /// `self` + `a` × `b`, rounded once.
    fn plus_product(self, a: Self, b: Self) -> Self;
    /// `self` − `a` × `b`, rounded once.
    fn minus_product(self, a: Self, b: Self) -> Self;
    /// `self` where the mask is true, `other` elsewhere.
    fn or_where_not(self, mask: Self::Mask, other: Self) -> Self;

    /// The smaller of `self` and `other`; `other` if either is not a number.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.or_where_not(self.lt(other), other)
    }

    /// The larger of `self` and `other`; `other` if either is not a number.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.or_where_not(other.lt(self), other)
    }
}
