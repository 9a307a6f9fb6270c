//! Golden hashes of some scenes, bit for bit: they must not change when code is moved or renamed.
//!
//! Each scene runs for 60 and for 600 ticks. A hash covers positions, velocities and normals every 60
//! ticks. It holds for every batch width and every instruction set with a fused
//! multiply-add; those without one have hashes of their own, which hold for every width, too.

mod figures;
mod hash;
mod scenes;

use bunting_solver::{LaneCount, has_fused_products, instruction_set, with_every_instruction_set};

pub use hash::StateHash;

use self::scenes::{GoldenScene, SceneEnd};
use crate::figure::Figure;

/// A scene's name and its hashes.
#[derive(Clone, Debug, PartialEq)]
pub struct GoldenHash {
    /// The scene.
    pub scene: &'static str,
    /// Hash of its states up to each of [`TICKS`].
    pub hashes: [u64; 2],
    /// Batch widths and instruction sets with other hashes; empty if all agree.
    pub deviations: Vec<String>,
    /// What its cloth is like after each of [`TICKS`].
    pub figures: Vec<Figure>,
}

/// Lengths of a run, ticks. Instruction sets without fused multiply-add emulate it in software, fifty times
/// slower, and do the shorter run only.
pub const TICKS: [u32; 2] = [60, 600];

/// Batch widths that must hash alike.
const WIDTHS: [LaneCount; 3] = [LaneCount::One, LaneCount::Eight, LaneCount::Sixteen];

/// A scene at one batch width.
#[derive(Clone, Copy, Debug)]
pub struct Piece {
    scene: &'static GoldenScene,
    lanes: LaneCount,
}

/// Every scene at every batch width, in the order of [`collect`].
pub fn pieces() -> impl Iterator<Item = Piece> {
    scenes::ALL.iter().flat_map(|scene| WIDTHS.map(|lanes| Piece { scene, lanes }))
}

/// The hashes of the scenes, from the runs of all [`pieces`].
///
/// # Panics
///
/// When runs of a piece are missing.
#[must_use]
pub fn collect(runs: &[Vec<Run>]) -> Vec<GoldenHash> {
    assert_eq!(runs.len(), scenes::ALL.len() * WIDTHS.len(), "runs of each piece");
    let scenes_and_runs = scenes::ALL.iter().zip(runs.chunks(WIDTHS.len()));
    scenes_and_runs.map(|(scene, runs)| golden_hash(scene.name, runs.concat())).collect()
}

/// One run of a scene.
#[derive(Clone, Debug)]
pub struct Run {
    /// Batch width and instruction set.
    setup: String,
    /// Whether the instruction set has a fused multiply-add. Those without one have hashes of their own.
    is_fused: bool,
    /// Index of the run's length in [`TICKS`].
    length: usize,
    end: SceneEnd,
}

impl Piece {
    /// All runs at this batch width with every instruction set of this machine where it can be chosen, the best first.
    ///
    /// # Panics
    ///
    /// When the scene panics.
    #[must_use]
    pub fn run(self) -> Vec<Run> {
        let Self { scene, lanes } = self;
        let runs = || {
            let is_fused = has_fused_products();
            let setup = format!("{} lanes, {}", lanes.get(), instruction_set());
            let is_available = LaneCount::available().contains(&lanes);
            let lengths = if is_available { 0..TICKS.len() } else { 0..0 };
            let run = |length: usize| {
                let end = (scene.run)(lanes, TICKS[length]);
                Run { setup: setup.clone(), is_fused, length, end }
            };
            lengths.map(run).collect::<Vec<_>>()
        };
        if scene.is_in_pool { runs() } else { with_every_instruction_set(runs).concat() }
    }
}

/// The hashes and figures of a scene's first run of each length, and the runs with other hashes.
fn golden_hash(scene: &'static str, runs: Vec<Run>) -> GoldenHash {
    let first = |is_fused: bool, length: usize| {
        runs.iter().find(|run| (run.is_fused, run.length) == (is_fused, length))
    };
    let hash = |is_fused: bool, length: usize| first(is_fused, length).map(|run| run.end.hash);
    let hashes = [0, 1].map(|length| hash(true, length).unwrap_or(0));
    let deviating = runs.iter().filter(|run| Some(run.end.hash) != hash(run.is_fused, run.length));
    let deviations = deviating
        .map(|run| format!("{}, {} ticks: {:016x}", run.setup, TICKS[run.length], run.end.hash));
    let deviations = deviations.collect();
    let ends = [0, 1].map(|length| first(true, length));
    let figures = ends.into_iter().flatten().flat_map(|run| {
        let of_scene = format!("golden: {scene}, {} ticks", TICKS[run.length]);
        run.end.figures.iter().map(move |figure| figure.clone().of(&of_scene))
    });
    GoldenHash { scene, hashes, deviations, figures: figures.collect() }
}

/// The committed list, one line for each scene: its name and its hashes, separated by tabs.
pub const EXPECTED: &str = include_str!("../../expected/golden_hashes.tsv");

/// The list in the format of the committed one.
#[must_use]
pub fn list(hashes: &[GoldenHash]) -> String {
    let line = |it: &GoldenHash| {
        let [short, long] = it.hashes;
        format!("{}\t{short:016x}\t{long:016x}\n", it.scene)
    };
    hashes.iter().map(line).collect()
}
