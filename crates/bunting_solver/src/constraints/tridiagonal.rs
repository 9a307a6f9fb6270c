//! Rows of the tridiagonal systems of chains.

use crate::simd::lane::Pack;
use crate::simd::vec3::Pack3;

/// A row of a chain's tridiagonal system, for one link: values that the elimination (Thomas's algorithm)
/// stores for the substitution.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TridiagonalRow<P: Pack> {
    /// Vector d from the link's first particle to its second, m.
    pub along: Pack3<P>,
    /// Thomas coefficient: the factor of this row's unknown in the unknown of the row before.
    pub multiplier: P,
    /// Unknown of this row, λ/|d|, without its term in the next unknown. Before a masked elimination, one where the row
    /// is solved and zero elsewhere.
    pub unknown: P,
    /// Change of the link's target for a unit change of the unknown, α̃ |d|, m.
    pub target_change: P,
}

impl<P: Pack> TridiagonalRow<P> {
    /// A row of zeros.
    pub fn new() -> Self {
        let zero = P::splat(0.0);
        Self { along: [zero; 3], multiplier: zero, unknown: zero, target_change: zero }
    }
}
