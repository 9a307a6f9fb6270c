//! Results kept on disk, keyed by everything that they depend on.

use std::{
    env, fs,
    hash::{DefaultHasher, Hash, Hasher},
    path::{Path, PathBuf},
};

use serde::{Serialize, de::DeserializeOwned};

/// Source of the reference's model and of the scenes, so that each edition has results of its own. A number that is
/// changed by hand was forgotten once, and new masses were compared with results of the old.
const SOURCES: [&str; 7] = [
    include_str!("forces.rs"),
    include_str!("grid.rs"),
    include_str!("mod.rs"),
    include_str!("relaxation.rs"),
    include_str!("verlet.rs"),
    include_str!("xpbd.rs"),
    include_str!("../scenes.rs"),
];

/// Result of `compute`, from the cache if `compute` has run before with an equal key.
///
/// A cache that cannot be read or written costs time, but causes no failure.
pub fn cached<T: Serialize + DeserializeOwned>(
    key: &impl Serialize,
    compute: impl FnOnce() -> T,
) -> T {
    let key = text_of(key);
    let path = file_of(&key);
    let stored =
        fs::read(&path).ok().and_then(|bytes| postcard::from_bytes::<(String, T)>(&bytes).ok());
    if let Some((stored_key, result)) = stored
        && stored_key == key
    {
        return result;
    }
    let result = compute();
    if let (Some(folder), Ok(bytes)) = (path.parent(), postcard::to_stdvec(&(&key, &result))) {
        let _ = fs::create_dir_all(folder).and_then(|()| fs::write(&path, bytes));
    }
    result
}

/// The key with the edition of the model, as text.
fn text_of(key: &impl Serialize) -> String {
    let mut edition = DefaultHasher::new();
    SOURCES.hash(&mut edition);
    serde_json::to_string(&(edition.finish(), key)).expect("a scene is plain numbers and names")
}

fn file_of(key: &str) -> PathBuf {
    let mut hasher = DefaultHasher::new();
    key.hash(&mut hasher);
    let target = env::var_os("CARGO_TARGET_DIR")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target"), PathBuf::from);
    target.join("lab-cache").join(format!("{:016x}.postcard", hasher.finish()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn second_call_reads_the_first() {
        let key = ("cache test", std::process::id());
        let _ = fs::remove_file(file_of(&text_of(&key)));
        assert_eq!(cached(&key, || vec![1.5, 2.5]), [1.5, 2.5]);
        assert_eq!(cached(&key, || -> Vec<f64> { unreachable!("cached") }), [1.5, 2.5]);
        fs::remove_file(file_of(&text_of(&key))).unwrap();
    }
}
