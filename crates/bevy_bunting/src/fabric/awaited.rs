//! Levels that another thread is building.

/// Everything that the levels of a cloth depend on, bit for bit; each list after its length.
pub(super) type ContentKey = Vec<u32>;

/// Levels that a cloth waits for.
#[derive(Clone, Debug)]
pub(crate) struct AwaitedLevels {
    pub(super) key: ContentKey,
    /// Tick before which the levels are not taken.
    pub(super) due: u64,
}
