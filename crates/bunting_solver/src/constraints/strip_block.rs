//! A row of a strip after elimination.

use crate::constraints::strip_system::UNKNOWNS;
use crate::simd::lane::Pack;
use crate::simd::vec3::Pack3;

/// A row after elimination, as the substitution needs it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StripBlock<P: Pack> {
    /// Directions of the link across, of those along both lines, and of both diagonals; zero where there is none.
    pub directions: [Pack3<P>; 5],
    /// Coefficients of the next row's unknowns in this row's unknowns.
    pub next: [[P; UNKNOWNS]; UNKNOWNS],
    /// Unknowns of the row without the contribution of the next row's, m³.
    pub unknowns: [P; UNKNOWNS],
}

impl<P: Pack> StripBlock<P> {
    /// A block of zeros.
    pub fn new() -> Self {
        let zero = P::splat(0.0);
        Self {
            directions: [[zero; 3]; 5],
            next: [[zero; UNKNOWNS]; UNKNOWNS],
            unknowns: [zero; UNKNOWNS],
        }
    }
}
