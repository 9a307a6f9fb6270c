//! The range of the factors of regions.

/// Least factor but for a bending of 0. Smaller: single particles swing so fast that they dominate the cloth's substeps.
pub(super) const LEAST: f32 = 1e-3;

/// Greatest factor. Larger: beside it the rest of the cloth is rounding.
pub(super) const GREATEST: f32 = 1e6;
