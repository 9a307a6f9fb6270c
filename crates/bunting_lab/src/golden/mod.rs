//! Hashes of six scenes, to the bit: what must not change when code is moved or renamed.
//!
//! Each scene runs for 600 ticks. Its hash covers positions, velocities and normals every 60 ticks. One
//! hash holds for every batch width and every instruction set.

mod hash;
mod scenes;

use bunting_solver::{LaneCount, with_every_instruction_set};

pub use hash::StateHash;

/// A scene's name and its hash.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GoldenHash {
    /// The scene.
    pub scene: &'static str,
    /// Hash of its states.
    pub hash: u64,
    /// Batch widths and instruction sets whose hash differs from `hash`; empty where all agree.
    pub deviations: Vec<String>,
}

/// Runs every scene at every batch width with every instruction set of this machine.
#[must_use]
pub fn measure() -> Vec<GoldenHash> {
    scenes::ALL.iter().map(|&(scene, run)| golden_hash(scene, run)).collect()
}

fn golden_hash(scene: &'static str, run: scenes::Run) -> GoldenHash {
    let mut hashes = Vec::new();
    for lanes in [LaneCount::One, LaneCount::Eight, LaneCount::Sixteen] {
        let of_sets =
            with_every_instruction_set(|| (bunting_solver::instruction_set(), run(lanes)));
        hashes.extend(of_sets.into_iter().map(|(set, hash)| (lanes, set, hash)));
    }
    let (_, _, hash) = hashes[0];
    let deviations = hashes
        .iter()
        .filter(|(_, _, other)| *other != hash)
        .map(|(lanes, set, other)| format!("{} lanes, {set}: {other:016x}", lanes.get()))
        .collect();
    GoldenHash { scene, hash, deviations }
}

/// The committed list, a line a scene: its name, a tab, its hash.
pub const EXPECTED: &str = include_str!("../../expected/golden_hashes.tsv");

/// The list as it would be committed.
#[must_use]
pub fn list(hashes: &[GoldenHash]) -> String {
    hashes.iter().map(|it| format!("{}\t{:016x}\n", it.scene, it.hash)).collect()
}
