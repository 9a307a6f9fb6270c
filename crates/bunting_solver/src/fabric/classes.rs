//! Classes: tables of the distinct values of constraints. Values that differ by rounding only are one class.

use core::hash::Hash;
use std::collections::HashMap;

/// Indices into a table of distinct values, found by keys made of [`rounded_bits`].
pub(super) struct Classes<K> {
    indices: HashMap<K, u32>,
}

/// Number of low bits of an f32 that a key ignores: values within about 2⁻¹² of one another are one class.
/// Fewer: the rounding of positions splits classes, and tables grow as long as the lists. More: stiffnesses
/// are off.
const IGNORED_BITS: u32 = 12;

/// Key of a value, equal for all values of one class.
pub(super) fn rounded_bits(value: f32) -> u32 {
    (value.to_bits() + (1 << (IGNORED_BITS - 1))) >> IGNORED_BITS
}

impl<K: Eq + Hash> Classes<K> {
    pub fn new() -> Self {
        Self { indices: HashMap::new() }
    }

    /// Returns the class of a key, and whether it is new: its value must then be appended to the table.
    pub fn class_of(&mut self, key: K) -> (u32, bool) {
        let next = self.indices.len() as u32;
        let class = *self.indices.entry(key).or_insert(next);
        (class, class == next)
    }
}
