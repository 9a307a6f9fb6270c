//! Errors of transfers between levels.

/// Reason why two fabrics are not neighbouring levels of a cloth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TransferError {
    /// The fabrics are no grids, so that their shared vertices must be given.
    #[error("the fabrics are no grids: say which vertices they share")]
    NotAGrid,
    /// The vertices of the coarser fabric are not some of the finer one's.
    #[error(
        "{given} shared vertices do not fit a fabric of {expected}, or are not the finer one's"
    )]
    NotShared {
        /// Number of given shared vertices.
        given: usize,
        /// Number of vertices of the coarser fabric.
        expected: usize,
    },
    /// A fabric has no triangles that can be searched.
    #[error("the surface of a fabric cannot be searched: its triangles have no area")]
    NoSurface,
    /// The finer grid does not have exactly one particle between any two neighbours of the coarser one.
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
