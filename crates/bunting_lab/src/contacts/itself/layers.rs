//! The layers of a cloth that touches itself.

/// Distance that layers of cloth keep from one another, m.
pub(super) const LAYERS: f32 = 5e-3;
