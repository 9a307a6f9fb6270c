//! Snapshots as bytes: what they are, a version, a checksum, and the state as postcard writes it.

use std::sync::Arc;

use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::save::cloth::ClothSnapshot;
use crate::save::world::ClothWorldSnapshot;

/// Version of the format. It grows with every change of what is saved, so that bytes of another version are known.
const VERSION: u32 = 4;

/// The first bytes of the snapshot of a cloth.
const CLOTH: [u8; 8] = *b"BuntingC";

/// The first bytes of the snapshot of a world.
const WORLD: [u8; 8] = *b"BuntingW";

/// Number of bytes before the state: what they are, the version and the checksum.
const HEADER: usize = 16;

/// Reason why bytes are no snapshot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SnapshotBytesError {
    /// The bytes are something else.
    #[error(
        "these bytes are no snapshot of {expected}: give those that to_bytes of the same type has returned"
    )]
    Foreign {
        /// What they should be a snapshot of.
        expected: &'static str,
    },
    /// The bytes are of another version of the crate.
    #[error(
        "the snapshot has version {found}, and this version of bevy_bunting reads version {expected}: restore it with the version that saved it, or let the cloth start anew"
    )]
    Version {
        /// Version of the bytes.
        found: u32,
        /// Version that is read.
        expected: u32,
    },
    /// Bytes are missing or changed.
    #[error("the snapshot is damaged: take another copy of it, or let the cloth start anew")]
    Damaged,
}

impl ClothSnapshot {
    /// The snapshot as bytes, which are the same on every machine.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        to_bytes(CLOTH, &*self.0)
    }

    /// The snapshot that was written as bytes.
    ///
    /// # Errors
    ///
    /// The bytes are something else, of another version, or damaged.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, SnapshotBytesError> {
        Ok(Self(Arc::new(from_bytes((CLOTH, "a cloth"), bytes)?)))
    }
}

impl ClothWorldSnapshot {
    /// The snapshot as bytes, which are the same on every machine.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        to_bytes(WORLD, &self.0)
    }

    /// The snapshot that was written as bytes.
    ///
    /// # Errors
    ///
    /// The bytes are something else, of another version, or damaged.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, SnapshotBytesError> {
        Ok(Self(from_bytes((WORLD, "all cloths"), bytes)?))
    }
}

impl From<ClothSnapshot> for Vec<u8> {
    fn from(snapshot: ClothSnapshot) -> Self {
        snapshot.to_bytes()
    }
}

impl TryFrom<Vec<u8>> for ClothSnapshot {
    type Error = SnapshotBytesError;

    fn try_from(bytes: Vec<u8>) -> Result<Self, SnapshotBytesError> {
        Self::from_bytes(&bytes)
    }
}

impl From<ClothWorldSnapshot> for Vec<u8> {
    fn from(snapshot: ClothWorldSnapshot) -> Self {
        snapshot.to_bytes()
    }
}

impl TryFrom<Vec<u8>> for ClothWorldSnapshot {
    type Error = SnapshotBytesError;

    fn try_from(bytes: Vec<u8>) -> Result<Self, SnapshotBytesError> {
        Self::from_bytes(&bytes)
    }
}

fn to_bytes(kind: [u8; 8], saved: &impl Serialize) -> Vec<u8> {
    let mut bytes = vec![0; HEADER];
    bytes[..8].copy_from_slice(&kind);
    bytes[8..12].copy_from_slice(&VERSION.to_le_bytes());
    let mut bytes = postcard::to_extend(saved, bytes).expect("lists in memory have lengths");
    let checksum = crc32fast::hash(&bytes[HEADER..]);
    bytes[12..HEADER].copy_from_slice(&checksum.to_le_bytes());
    bytes
}

fn from_bytes<T: DeserializeOwned>(
    (kind, expected): ([u8; 8], &'static str),
    bytes: &[u8],
) -> Result<T, SnapshotBytesError> {
    let foreign = SnapshotBytesError::Foreign { expected };
    let bytes = bytes.strip_prefix(&kind).ok_or(foreign)?;
    let (version, bytes) = first_number(bytes)?;
    if version != VERSION {
        return Err(SnapshotBytesError::Version { found: version, expected: VERSION });
    }
    let (checksum, bytes) = first_number(bytes)?;
    if checksum != crc32fast::hash(bytes) {
        return Err(SnapshotBytesError::Damaged);
    }
    postcard::from_bytes(bytes).map_err(|_| SnapshotBytesError::Damaged)
}

fn first_number(bytes: &[u8]) -> Result<(u32, &[u8]), SnapshotBytesError> {
    let (number, rest) = bytes.split_first_chunk().ok_or(SnapshotBytesError::Damaged)?;
    Ok((u32::from_le_bytes(*number), rest))
}
