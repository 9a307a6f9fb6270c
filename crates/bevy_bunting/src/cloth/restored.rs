//! Restorations: what was changed before one is part of the restored state, and not a change since the last tick.

use bevy_ecs::change_detection::Tick;

/// When something was restored, as a tick of change; never, if that was before the last tick of cloth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct RestoredAt(Option<Tick>);

impl RestoredAt {
    /// At a tick of change.
    pub fn new(at: Tick) -> Self {
        Self(Some(at))
    }

    /// Whether a change was made after the restoration, or there was none. Both ticks lie within one tick of cloth, so that
    /// their difference tells.
    pub fn is_before(self, changed: Tick) -> bool {
        self.0.is_none_or(|at| changed.get().wrapping_sub(at.get()).cast_signed() > 0)
    }
}

/// What a restored cloth brings into the next tick besides its state.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Restored {
    pub at: RestoredAt,
    /// What systems are to see of the cloth.
    pub pending: Pending,
    /// Whether colliders were near the cloth in its last tick, which the lane that it had then would know.
    pub touches: bool,
}

/// Changes of a cloth that systems have not seen yet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Pending {
    /// Those that the choice of levels has not seen.
    pub levels: bool,
    /// Those that the assignment of lanes has not seen.
    pub lanes: bool,
}
