//! How wide a batch is.

use crate::instruction_set::instruction_set;

/// How many cloths ride side by side in a batch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum LaneCount {
    /// One cloth. Cut from a grid it fills lanes with its own yarns; other meshes are scalar code.
    One,
    /// Eight cloths: full speed with AVX2.
    #[default]
    Eight,
    /// Sixteen cloths: full speed with AVX-512.
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

    /// The narrowest width that holds `cloths`, at most the widest that pays on this machine.
    #[must_use]
    pub fn holding(cloths: usize) -> Self {
        match cloths {
            0 | 1 => Self::One,
            2..=8 => Self::Eight,
            _ if instruction_set() == "AVX-512" => Self::Sixteen,
            _ => Self::Eight,
        }
    }
}
