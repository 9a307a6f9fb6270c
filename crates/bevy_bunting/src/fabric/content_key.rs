//! What the levels of a cloth depend on.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;

/// Everything that the levels of a cloth depend on, bit for bit; each list after its length. A mesh has thousands of numbers, so
/// they are hashed once, and shared by clones.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct ContentKey {
    hash: u64,
    content: Arc<[u32]>,
}

impl From<Vec<u32>> for ContentKey {
    fn from(content: Vec<u32>) -> Self {
        let mut hasher = DefaultHasher::new();
        content.hash(&mut hasher);
        Self { hash: hasher.finish(), content: content.into() }
    }
}

impl Hash for ContentKey {
    fn hash<H: Hasher>(&self, state: &mut H) {
        state.write_u64(self.hash);
    }
}
