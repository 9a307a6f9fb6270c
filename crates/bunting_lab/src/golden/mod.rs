//! Hashes of six scenes, to the bit: what must not change when code is moved or renamed.
//!
//! Each scene runs for 60 and for 600 ticks. A hash covers positions, velocities and normals every 60
//! ticks. It holds for every batch width and every instruction set.

mod hash;
mod scenes;

use std::thread;

use bunting_solver::{LaneCount, instruction_set, with_every_instruction_set};

pub use hash::StateHash;

/// A scene's name and its hashes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GoldenHash {
    /// The scene.
    pub scene: &'static str,
    /// Hash of its states up to each of [`TICKS`].
    pub hashes: [u64; 2],
    /// Batch widths and instruction sets that hash otherwise; empty where all agree.
    pub deviations: Vec<String>,
}

/// Lengths of a run, ticks. Instruction sets without fused multiply-add emulate it in software, fifty
/// times slower, and take the shorter run alone.
pub const TICKS: [u32; 2] = [60, 600];

/// Instruction sets with fused multiply-add.
const FUSED: [&str; 3] = ["AVX-512", "AVX2", "NEON"];

/// Runs every scene at every batch width with every instruction set of this machine, a thread a scene.
///
/// # Panics
///
/// When a scene does.
#[must_use]
pub fn measure() -> Vec<GoldenHash> {
    thread::scope(|scope| {
        let runs: Vec<_> = scenes::ALL
            .iter()
            .map(|&(scene, run)| scope.spawn(move || golden_hash(scene, run)))
            .collect();
        runs.into_iter().map(|run| run.join().expect("a scene runs to its end")).collect()
    })
}

fn golden_hash(scene: &'static str, run: scenes::Run) -> GoldenHash {
    let mut first = [None; 2];
    let mut deviations = Vec::new();
    for lanes in [LaneCount::One, LaneCount::Eight, LaneCount::Sixteen] {
        with_every_instruction_set(|| {
            let set = instruction_set();
            for (first, ticks) in first.iter_mut().zip(TICKS) {
                if ticks > TICKS[0] && !FUSED.contains(&set) {
                    continue;
                }
                let hash = run(lanes, ticks);
                if *first.get_or_insert(hash) != hash {
                    let lanes = lanes.get();
                    deviations.push(format!("{lanes} lanes, {set}, {ticks} ticks: {hash:016x}"));
                }
            }
        });
    }
    GoldenHash { scene, hashes: first.map(Option::unwrap_or_default), deviations }
}

/// The committed list, a line a scene: its name and its hashes, separated by tabs.
pub const EXPECTED: &str = include_str!("../../expected/golden_hashes.tsv");

/// The list as it would be committed.
#[must_use]
pub fn list(hashes: &[GoldenHash]) -> String {
    let line = |it: &GoldenHash| {
        let [short, long] = it.hashes;
        format!("{}\t{short:016x}\t{long:016x}\n", it.scene)
    };
    hashes.iter().map(line).collect()
}
