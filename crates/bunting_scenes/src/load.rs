//! Reads scene files.

use std::fs;
use std::path::Path;

use ron::error::{Position, SpannedError};
use ron::extensions::Extensions;

use crate::check;
use crate::error::SceneError;
use crate::key::Key;
use crate::scene::Scene;

/// Reads a scene and checks its values.
///
/// # Errors
///
/// A [`SceneError`] names the file, and the line, the column and the key of the first value that is
/// missing, of the wrong type, or out of range.
pub fn load(file: impl AsRef<Path>) -> Result<Scene, SceneError> {
    let file = file.as_ref();
    let source = fs::read_to_string(file)
        .map_err(|source| SceneError::Unreadable { file: file.to_owned(), source })?;
    parse(&source, file)
}

/// Reads a scene from text; errors name `file` as its source.
///
/// # Errors
///
/// As [`load`].
pub fn parse(source: &str, file: &Path) -> Result<Scene, SceneError> {
    let bad_value = |at: Position, key: Key, reason: String| SceneError::BadValue {
        file: file.to_owned(),
        line: at.line,
        column: at.col,
        key: key.to_string(),
        reason,
    };
    let bad_syntax = |error: SpannedError, key: Key| {
        let at = match error.code {
            ron::Error::NoSuchStructField { .. } => error.span.start,
            ron::Error::MissingStructField { .. } => key.position(source, &syntax()),
            _ => error.span.end,
        };
        bad_value(at, key, error.code.to_string())
    };
    let mut parser = ron::Deserializer::from_str_with_options(source, &syntax())
        .map_err(|error| bad_syntax(error, Key::default()))?;
    let scene: Scene = serde_path_to_error::deserialize(&mut parser).map_err(|error| {
        let key = Key::from(error.path());
        bad_syntax(parser.span_error(error.into_inner()), key)
    })?;
    parser.end().map_err(|error| bad_syntax(parser.span_error(error), Key::default()))?;
    check::scene(&scene)
        .map_err(|bad| bad_value(bad.key.position(source, &syntax()), bad.key, bad.reason))?;
    Ok(scene)
}

/// RON in which optional values need no `Some`.
fn syntax() -> ron::Options {
    ron::Options::default().with_default_extension(Extensions::IMPLICIT_SOME)
}
