//! Errors of transfers between levels.

/// Reason why two fabrics are not neighbouring levels of a cloth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TransferError {
    /// The fabrics are no grids.
    #[error("the fabrics are no grids: use `LevelTransfer::of_surface`")]
    NotAGrid,
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
