//! The level of a cloth for which something was found.

use std::sync::{Arc, Weak};

use crate::fabric::levels::ClothLevels;

/// The level of a cloth for which something was found, such as its pins. It does not keep the fabrics alive, which may
/// be those of a cloth that is gone.
#[derive(Clone, Debug, Default)]
pub(crate) struct KnownLevel {
    /// As long as this is here, no other levels lie at the same address.
    levels: Weak<ClothLevels>,
    level: usize,
}

impl KnownLevel {
    /// A level.
    pub fn new(levels: &Arc<ClothLevels>, level: usize) -> Self {
        Self { levels: Arc::downgrade(levels), level }
    }

    /// Whether it is this level.
    pub fn is(&self, levels: &Arc<ClothLevels>, level: usize) -> bool {
        core::ptr::eq(self.levels.as_ptr(), Arc::as_ptr(levels)) && self.level == level
    }

    /// Whether it is a level of this number.
    pub fn has_number(&self, level: usize) -> bool {
        self.level == level
    }
}
