//! The width of a batch.

use crate::fabric::Fabric;
use crate::simd::level::has_avx512;
use crate::step::Scheme;

/// Most particles of a fabric of which sixteen cloths are put into one batch. Larger: the state no longer fits into the
/// second-level cache, and sixteen lanes gain nothing at 65 × 65 and lose 18 % at 129 × 129.
const MOST_IN_SIXTEEN: usize = 65 * 65;

/// Number of cloths that a batch can hold.
///
/// ```
/// use bunting_solver::LaneCount;
///
/// assert_eq!(LaneCount::Eight.get(), 8);
/// assert_eq!(LaneCount::holding(1), LaneCount::One);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[cfg_attr(
    feature = "bevy_reflect",
    derive(bevy_reflect::Reflect),
    type_path = "bunting_solver",
    reflect(Debug, PartialEq, Hash, Clone)
)]
pub enum LaneCount {
    /// One cloth, whose lines are spread across the lanes of a vector.
    One,
    /// Eight cloths: full speed with AVX2.
    #[default]
    Eight,
    /// Sixteen cloths, on machines with AVX-512. Elsewhere batches of sixteen have eight lanes, since two registers of
    /// eight lanes are no faster together than one after the other.
    Sixteen,
}

impl LaneCount {
    /// Number of lanes.
    #[must_use]
    pub const fn get(self) -> usize {
        match self {
            Self::One => 1,
            Self::Eight => 8,
            Self::Sixteen => 16,
        }
    }

    /// The widths that this machine has, the narrowest first.
    #[must_use]
    pub fn available() -> &'static [Self] {
        let all = &[Self::One, Self::Eight, Self::Sixteen];
        if has_avx512() { all } else { &all[..2] }
    }

    /// The greatest width that this machine has.
    #[must_use]
    pub fn widest() -> Self {
        if has_avx512() { Self::Sixteen } else { Self::Eight }
    }

    /// The narrowest width that holds `cloths`, at most the widest that this machine has.
    #[must_use]
    pub fn holding(cloths: usize) -> Self {
        match cloths {
            0 | 1 => Self::One,
            2..=8 => Self::Eight,
            _ => Self::widest(),
        }
    }

    /// Width of the first batch if `cloths` cloths of a fabric are divided among batches such that they take
    /// the least time: full batches of the widest width, and narrower ones for the rest.
    #[must_use]
    pub fn first_of(cloths: usize, fabric: &Fabric, scheme: Scheme) -> Self {
        let alone = Self::most_alone(fabric, scheme);
        match cloths {
            _ if cloths <= alone => Self::One,
            9.. if cloths - 8 >= alone && fabric.particle_count() <= MOST_IN_SIXTEEN => {
                Self::holding(cloths)
            }
            _ => Self::Eight,
        }
    }

    /// Greatest number of cloths of a fabric that take less time in batches of one lane than side by side in
    /// eight lanes. Beside a batch of eight, the number is one less.
    ///
    /// A 33 × 33 flag takes 55 µs a tick by itself, eight side by side take 220 µs and sixteen 400 µs; at 17
    /// × 17 the times are 8.7, 29 and 48 µs, at 9 × 9 3.5, 7.8 and 12 µs, at 5 × 5 1.7, 2.6 and 3.7 µs: short
    /// rows leave most lanes empty.
    #[must_use]
    pub fn most_alone(fabric: &Fabric, scheme: Scheme) -> usize {
        const WIDE: u32 = 16;
        let wide = fabric.grid().is_some_and(|grid| grid.columns > WIDE);
        if wide && scheme == Scheme::Yarns { 3 } else { 1 }
    }
}
