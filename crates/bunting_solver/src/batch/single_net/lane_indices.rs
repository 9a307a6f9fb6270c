//! What each lane of a pack holds, of a list of the fabric.

use crate::simd::lane::Pack;
use crate::simd::registers::Pack8;

/// For each lane of a pack an index into a list of the fabric; [`NO_INDEX`] in lanes without a constraint.
pub(super) type LaneIndices = [u32; Pack8::WIDTH];

/// Index of no element.
pub(super) const NO_INDEX: u32 = u32::MAX;
