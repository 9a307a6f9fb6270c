//! Factor on bending stiffness at the border of a clamp.

/// Factor on the bending stiffness at the border of a clamp, where a bending constraint covers only half a cell
/// of free cloth. With 1 a heavy cantilever converges at first order with the number of cells, with 2 at second.
pub(super) const CLAMP_FACTOR: f32 = 2.0;
