//! The rail.

/// Distance from the middle of one cloth to that of the next, m.
pub const SPACING: f32 = 0.3;

/// Height of the rail, m.
pub const RAIL: f32 = 1.55;
