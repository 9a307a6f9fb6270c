//! A hash over the bits of states.

use glam::Vec3;

/// FNV-1a, 64 bits (Fowler, Noll and Vo 1991), over the bits of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StateHash(u64);

impl StateHash {
    /// The hash of an empty sequence.
    #[must_use]
    pub const fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    /// Adds vectors, component by component.
    pub fn add(&mut self, vectors: &[Vec3]) {
        for component in vectors.iter().flat_map(|vector| vector.to_array()) {
            for byte in component.to_bits().to_le_bytes() {
                self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
            }
        }
    }

    /// The hash of all added vectors.
    #[must_use]
    pub const fn value(self) -> u64 {
        self.0
    }
}

impl Default for StateHash {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bit_and_the_order_count() {
        let of = |vectors: &[Vec3]| {
            let mut hash = StateHash::new();
            hash.add(vectors);
            hash.value()
        };
        let next = f32::from_bits(1.0_f32.to_bits() + 1);
        let hashes = [
            of(&[Vec3::X, Vec3::Y]),
            of(&[Vec3::Y, Vec3::X]),
            of(&[Vec3::X * next, Vec3::Y]),
            of(&[Vec3::X, Vec3::new(-0.0, 1.0, 0.0)]),
        ];
        for (index, hash) in hashes.iter().enumerate() {
            assert!(!hashes[..index].contains(hash));
        }
    }
}
