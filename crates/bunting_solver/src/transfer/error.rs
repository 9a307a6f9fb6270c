//! The ways in which two fabrics cannot be neighbouring levels.

/// The reason why two fabrics are not neighbours in a chain of levels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TransferError {
    /// Of fabrics that are not grids the shared vertices must be given.
    #[error("the fabrics are no grids: say which vertices they share")]
    NotAGrid,
    /// The coarser fabric must have some of the finer one's vertices.
    #[error(
        "{given} shared vertices do not fit a fabric of {expected}, or are not the finer one's"
    )]
    NotShared {
        /// Number of vertices that are said to be shared.
        given: usize,
        /// Number of vertices of the coarser fabric.
        expected: usize,
    },
    /// The finer grid must have a particle halfway between any two of the coarser.
    #[error(
        "{fine:?} particles do not halve to {coarse:?}: use 2ⁿ + 1 columns and rows, or any that halve"
    )]
    NotNested {
        /// Columns and rows of the finer grid.
        fine: (u32, u32),
        /// Columns and rows of the coarser grid.
        coarse: (u32, u32),
    },
}
