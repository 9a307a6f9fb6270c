//! What can be wrong with a scene file.

use std::io;
use std::path::PathBuf;

/// Why a scene file could not be loaded.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// The file could not be read.
    #[error("{}: {source}", file.display())]
    Unreadable {
        /// The file.
        file: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// A value is missing, of the wrong kind, or makes no sense.
    #[error("{}:{line}:{column}: {key}: {reason}", file.display())]
    BadValue {
        /// The file.
        file: PathBuf,
        /// Line of the value, from 1.
        line: usize,
        /// Column of the value, from 1.
        column: usize,
        /// The way to the value from the top of the file: `flags[2].size`; `scene` for the whole.
        key: String,
        /// What is wrong with it.
        reason: String,
    },
}
