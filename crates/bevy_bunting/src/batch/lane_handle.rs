//! The address of a cloth's lane.

/// Address of the lane that holds the state of a cloth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct LaneHandle {
    /// Index of the group of cloths that are stepped alike.
    pub group: usize,
    /// Index of the batch within the group.
    pub batch: usize,
    /// Index of the lane within the batch.
    pub lane: usize,
}
