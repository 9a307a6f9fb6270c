//! What each lane of a pack holds, of a list of the fabric.

/// For each lane of a pack an index into a list of the fabric; [`NO_INDEX`] in lanes without a constraint.
pub(super) type LaneIndices = [u32; MOST_LANES];

/// Index of no element.
pub(super) const NO_INDEX: u32 = u32::MAX;

/// Number of lanes of the widest pack.
pub(super) const MOST_LANES: usize = 16;
