//! Errors of scene files.

use std::io;
use std::path::PathBuf;

/// Reason why a scene file could not be loaded.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// The file could not be read.
    #[error("{}: {source}", file.display())]
    Unreadable {
        /// The file.
        file: PathBuf,
        /// The error of the system.
        source: io::Error,
    },
    /// A value is missing, of the wrong type, or out of range.
    #[error("{}:{line}:{column}: {key}: {reason}", file.display())]
    BadValue {
        /// The file.
        file: PathBuf,
        /// Line of the value, from 1.
        line: usize,
        /// Column of the value, from 1.
        column: usize,
        /// Path of the value from the top of the file: `flags[2].size`; `scene` for the whole.
        key: String,
        /// The reason.
        reason: String,
    },
}
