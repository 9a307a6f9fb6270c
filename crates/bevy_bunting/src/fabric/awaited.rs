//! Levels that another thread is building.

use crate::fabric::content_key::ContentKey;

/// Levels that a cloth waits for.
#[derive(Clone, Debug)]
pub(crate) struct AwaitedLevels {
    pub(super) key: ContentKey,
    /// Tick before which the levels are not taken.
    pub(super) due: u64,
}
