//! The widths: one, four, eight and sixteen floats, in memory and in registers. This is the only file that knows
//! the widths.

use core::ops::{Add, Div, Mul, Neg, Sub};

use fearless_simd::{Select, Simd, SimdBase, SimdFloat, f32x4, f32x8, f32x16};

use crate::simd::lane::{Kernel, Lane, Mask, Pack};
use crate::simd::level::{dispatch, fuses};
use crate::simd::transpose::{joined, split};
use crate::simd::vec3::V3;

/// A single lane: the scalar solver, with which the wide ones are compared in tests.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(crate) struct Pack1([f32; 1]);

/// The coordinates of a vector, and a fourth number: one SSE or NEON register.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(16))]
pub(crate) struct Pack4([f32; 4]);

impl Pack4 {
    /// Four numbers.
    #[inline]
    pub const fn new(numbers: [f32; 4]) -> Self {
        Self(numbers)
    }

    /// The four numbers.
    pub fn vector(&self) -> [f32; 4] {
        self.0
    }
}

/// Eight lanes: one AVX register, or two of SSE or NEON.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(crate) struct Pack8([f32; 8]);

/// Sixteen lanes: one AVX-512 register. No machine without AVX-512 has batches of it: two registers of eight lanes are
/// no faster together, and each further instruction set adds to this crate's compile time.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct Pack16([f32; 16]);

macro_rules! pack_memory {
    ($width:literal) => {
        const WIDTH: usize = $width;

        #[inline(always)]
        fn splat(value: f32) -> Self {
            Self([value; $width])
        }

        #[inline(always)]
        fn lanes(&self) -> &[f32] {
            &self.0
        }

        #[inline(always)]
        fn lanes_mut(&mut self) -> &mut [f32] {
            &mut self.0
        }
    };
}

impl Pack for Pack1 {
    pack_memory!(1);

    fn run<K: Kernel<Self>>(kernel: K) {
        #[inline(always)]
        fn with_token<S: Simd, K: Kernel<Pack1>>(token: S, kernel: K) {
            kernel.run::<Single<S>>(token);
        }
        dispatch!(token => with_token(token, kernel));
    }
}

macro_rules! pack_of_every_set {
    ($pack:ident, $vector:ident, $width:literal) => {
        impl Pack for $pack {
            pack_memory!($width);

            fn run<K: Kernel<Self>>(kernel: K) {
                #[inline(always)]
                fn with_token<S: Simd, K: Kernel<$pack>>(token: S, kernel: K) {
                    kernel.run::<$vector<S>>(token);
                }
                dispatch!(token => with_token(token, kernel));
            }
        }
    };
}

pack_of_every_set!(Pack4, f32x4, 4);
pack_of_every_set!(Pack8, f32x8, 8);

impl Pack for Pack16 {
    pack_memory!(16);

    #[cfg_attr(
        not(target_arch = "x86_64"),
        expect(unused_variables, reason = "sixteen lanes need AVX-512")
    )]
    fn run<K: Kernel<Self>>(kernel: K) {
        #[cfg(target_arch = "x86_64")]
        if let fearless_simd::Level::Avx512(set) = crate::simd::level::level() {
            return set.vectorize(
                #[inline(always)]
                || kernel.run::<f32x16<_>>(set),
            );
        }
        unreachable!("batches of sixteen lanes are made on machines with AVX-512 only")
    }
}

/// Gathers and scatters lane by lane.
macro_rules! one_by_one {
    () => {
        #[inline(always)]
        fn gather<V: Pack>(token: Self::Token, vectors: &[V], at: &[u32]) -> [Self; 3] {
            let mut packs = [Self::Pack::splat(0.0); 3];
            for (lane, &at) in at.iter().enumerate() {
                for (pack, number) in packs.iter_mut().zip(vectors[at as usize].lanes()) {
                    pack.lanes_mut()[lane] = *number;
                }
            }
            let [x, y, z] = &packs;
            [Self::load(token, x), Self::load(token, y), Self::load(token, z)]
        }

        #[inline(always)]
        fn scatter<V: Pack>(_: Self::Token, [x, y, z]: [Self; 3], vectors: &mut [V], at: &[u32]) {
            let mut packs = [Self::Pack::splat(0.0); 3];
            let [to_x, to_y, to_z] = &mut packs;
            x.store(to_x);
            y.store(to_y);
            z.store(to_z);
            for (lane, &at) in at.iter().enumerate() {
                let mut vector = V::splat(0.0);
                for (number, pack) in vector.lanes_mut().iter_mut().zip(&packs) {
                    *number = pack.lanes()[lane];
                }
                vectors[at as usize] = vector;
            }
        }
    };
}

/// Gathers and scatters vectors of four numbers whole, eight at once.
macro_rules! transposed {
    () => {
        #[inline(always)]
        fn gather<V: Pack>(token: S, vectors: &[V], at: &[u32]) -> [Self; 3] {
            let at: &[u32; 8] = at.first_chunk().expect("an index in each lane");
            let mut gathered = [<f32x4<S> as Lane>::splat(token, 0.0); 8];
            for lane in 0..8 {
                let vector = vectors[at[lane] as usize].lanes();
                gathered[lane] = SimdBase::from_slice(token, vector);
            }
            let V3 { x, y, z } = joined(gathered);
            [x, y, z]
        }

        #[inline(always)]
        fn scatter<V: Pack>(token: S, [x, y, z]: [Self; 3], vectors: &mut [V], at: &[u32]) {
            let at: &[u32; 8] = at.first_chunk().expect("an index in each lane");
            let from = split(token, V3 { x, y, z });
            for lane in 0..8 {
                from[lane].store_slice(vectors[at[lane] as usize].lanes_mut());
            }
        }
    };
}

macro_rules! lanes_of {
    ($pack:ident, $vector:ident, $width:literal, $gathers:ident) => {
        impl<S: Simd> Lane for $vector<S> {
            type Pack = $pack;
            type Token = S;
            type Mask = <$vector<S> as SimdBase<S>>::Mask;

            $gathers!();

            #[inline(always)]
            fn splat(token: S, value: f32) -> Self {
                SimdBase::splat(token, value)
            }

            #[inline(always)]
            fn load(token: S, pack: &$pack) -> Self {
                SimdBase::load_array_ref(token, &pack.0)
            }

            #[inline(always)]
            fn store(self, pack: &mut $pack) {
                SimdBase::store_array(self, &mut pack.0);
            }

            #[inline(always)]
            fn load_at(token: S, values: &[f32], at: usize) -> Self {
                SimdBase::from_slice(token, &values[at..at + $width])
            }

            #[inline(always)]
            fn store_at(self, values: &mut [f32], at: usize) {
                SimdBase::store_slice(&self, &mut values[at..at + $width]);
            }

            #[inline(always)]
            fn sqrt(self) -> Self {
                SimdFloat::sqrt(self)
            }

            #[inline(always)]
            fn abs(self) -> Self {
                SimdBase::abs(self)
            }

            #[inline(always)]
            fn lt(self, other: Self) -> Self::Mask {
                self.simd_lt(other)
            }

            #[inline(always)]
            fn plus_product(self, a: Self, b: Self) -> Self {
                if fuses(self.simd.level()) { a.mul_add_precise(b, self) } else { self + a * b }
            }

            #[inline(always)]
            fn minus_product(self, a: Self, b: Self) -> Self {
                self.plus_product(-a, b)
            }

            #[inline(always)]
            fn or_where_not(self, mask: Self::Mask, other: Self) -> Self {
                mask.select(self, other)
            }
        }
    };
}

lanes_of!(Pack4, f32x4, 4, one_by_one);
lanes_of!(Pack8, f32x8, 8, transposed);
lanes_of!(Pack16, f32x16, 16, one_by_one);

/// Implements [`Mask`] for a mask of fearless_simd.
macro_rules! mask_of_lanes {
    ($mask:ident) => {
        impl<S: Simd> Mask for fearless_simd::$mask<S> {
            #[inline(always)]
            fn any(self) -> bool {
                fearless_simd::SimdMask::any_true(self)
            }

            #[inline(always)]
            fn all(self) -> bool {
                fearless_simd::SimdMask::all_true(self)
            }

            #[inline(always)]
            fn bits(self) -> u64 {
                fearless_simd::SimdMask::to_bitmask(self)
            }
        }
    };
}

mask_of_lanes!(mask32x4);
mask_of_lanes!(mask32x8);
mask_of_lanes!(mask32x16);

impl Mask for bool {
    #[inline(always)]
    fn any(self) -> bool {
        self
    }

    #[inline(always)]
    fn all(self) -> bool {
        self
    }

    #[inline(always)]
    fn bits(self) -> u64 {
        self.into()
    }
}

/// A single float in a register, with proof of the instruction set, which decides whether a fused
/// multiply-add exists.
#[derive(Clone, Copy)]
struct Single<S> {
    value: f32,
    token: S,
}

impl<S: Simd> Single<S> {
    #[inline(always)]
    fn with(self, value: f32) -> Self {
        Self { value, ..self }
    }
}

macro_rules! single_operator {
    ($($operator:ident :: $method:ident),*) => {
        $(impl<S: Simd> $operator for Single<S> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.with($operator::$method(self.value, other.value))
            }
        })*
    };
}

single_operator!(Add::add, Sub::sub, Mul::mul, Div::div);

impl<S: Simd> Neg for Single<S> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        self.with(-self.value)
    }
}

impl<S: Simd> Lane for Single<S> {
    type Pack = Pack1;
    type Token = S;
    type Mask = bool;

    one_by_one!();

    #[inline(always)]
    fn splat(token: S, value: f32) -> Self {
        Self { value, token }
    }

    #[inline(always)]
    fn load(token: S, pack: &Pack1) -> Self {
        Self { value: pack.0[0], token }
    }

    #[inline(always)]
    fn store(self, pack: &mut Pack1) {
        pack.0[0] = self.value;
    }

    #[inline(always)]
    fn load_at(token: S, values: &[f32], at: usize) -> Self {
        Self { value: values[at], token }
    }

    #[inline(always)]
    fn store_at(self, values: &mut [f32], at: usize) {
        values[at] = self.value;
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        // Correctly rounded by IEEE 754 on every target.
        self.with(f32::sqrt(self.value))
    }

    #[inline(always)]
    fn abs(self) -> Self {
        self.with(f32::abs(self.value))
    }

    #[inline(always)]
    fn lt(self, other: Self) -> bool {
        self.value < other.value
    }

    #[inline(always)]
    #[expect(clippy::disallowed_methods, reason = "reached only where the instruction set has it")]
    fn plus_product(self, a: Self, b: Self) -> Self {
        self.with(if fuses(self.token.level()) {
            a.value.mul_add(b.value, self.value)
        } else {
            self.value + a.value * b.value
        })
    }

    #[inline(always)]
    fn minus_product(self, a: Self, b: Self) -> Self {
        self.plus_product(-a, b)
    }

    #[inline(always)]
    fn or_where_not(self, mask: bool, other: Self) -> Self {
        if mask { self } else { other }
    }
}
