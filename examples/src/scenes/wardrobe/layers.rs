//! What touches what.

/// Clothes, all of which may touch one another.
pub const CLOTHES: u32 = 1;

/// Head, neck, chest and shins.
pub const BODY: u32 = 2;

/// Hips and thighs, as the skirt touches them.
pub const BARE: u32 = 4;

/// Hips and thighs with a skirt on them, as what is worn over it touches them: cheaper than cloth that touches cloth.
pub const SKIRTED: u32 = 8;

/// Arms, which clothes without sleeves do not touch: they come out of them at the shoulders.
pub const ARMS: u32 = 16;

/// Ground and furniture.
pub const ROOM: u32 = 32;
