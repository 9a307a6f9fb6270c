//! Lists of vectors as bytes, for `#[serde(with = "bunting_solver::packed")]`: as long as their numbers, and many times
//! faster to write and to read than number by number. For formats that lend bytes of what they read.

use glam::Vec3;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serializer};

/// Number of bytes of a vector: three numbers, the lowest byte first.
const BYTES: usize = 12;

/// Writes vectors.
///
/// # Errors
///
/// Those of the format.
pub fn serialize<S: Serializer>(vectors: &[Vec3], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_bytes(&to_bytes(&[vectors]))
}

/// Reads vectors.
///
/// # Errors
///
/// Those of the format, and a number of bytes that is not that of whole vectors.
pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<Vec3>, D::Error> {
    let bytes = <&[u8]>::deserialize(deserializer)?;
    let (vectors, rest) = bytes.as_chunks::<BYTES>();
    if !rest.is_empty() {
        return Err(D::Error::invalid_length(bytes.len(), &"a multiple of twelve"));
    }
    Ok(vectors.iter().map(vector).collect())
}

/// Two lists of the same length.
pub(crate) mod pair {
    use glam::Vec3;
    use serde::{Deserializer, Serializer};

    use super::to_bytes;

    pub fn serialize<S: Serializer>(
        [one, other]: &[Vec<Vec3>; 2],
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        serializer.serialize_bytes(&to_bytes(&[one, other]))
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<[Vec<Vec3>; 2], D::Error> {
        let mut one = super::deserialize(deserializer)?;
        let other = one.split_off(one.len() / 2);
        Ok([one, other])
    }
}

fn to_bytes(lists: &[&[Vec3]]) -> Vec<u8> {
    let count: usize = lists.iter().map(|list| list.len()).sum();
    let mut bytes = vec![0; BYTES * count];
    let into = bytes.as_chunks_mut::<BYTES>().0;
    for (into, vector) in into.iter_mut().zip(lists.iter().copied().flatten()) {
        let numbers = into.as_chunks_mut::<{ size_of::<f32>() }>().0;
        for (into, number) in numbers.iter_mut().zip(vector.to_array()) {
            *into = number.to_le_bytes();
        }
    }
    bytes
}

fn vector(bytes: &[u8; BYTES]) -> Vec3 {
    let mut numbers = [0.0; 3];
    for (number, bytes) in numbers.iter_mut().zip(bytes.as_chunks::<{ size_of::<f32>() }>().0) {
        *number = f32::from_le_bytes(*bytes);
    }
    Vec3::from_array(numbers)
}
