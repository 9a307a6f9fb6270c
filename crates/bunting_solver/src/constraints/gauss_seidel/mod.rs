//! The thesis's scheme (4.4): Gauss–Seidel over single constraints, one after the other, pass after pass.

mod atan2;
pub(super) mod dihedral;
mod distance;
mod fold;
mod passes;
