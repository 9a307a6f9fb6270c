//! Memory of a chain of levels: its fabrics, the transfers between them, and batches of each width.

use std::sync::Arc;

use bunting_solver::{ClothBatch, ClothSnapshot, Fabric, LaneCount, LevelTransfer};
use serde::Serialize;
use serde_json::json;

use crate::{
    heap::held_by,
    output::{Outcome, table::Table},
    product::{self, DEFAULT, TICK},
    scenes::Scene,
    settings::LEVELS,
};

/// Bytes in a KiB.
const KIB: f64 = 1024.0;

/// The fabric of a level.
#[derive(Clone, Debug, Serialize)]
struct FabricMemory {
    /// Vertices along each side.
    n: u32,
    bytes: usize,
}

/// The transfer from a level to the next coarser one and back.
#[derive(Clone, Debug, Serialize)]
struct TransferMemory {
    /// Vertices along each side of the finer level.
    from: u32,
    /// Vertices along each side of the coarser level.
    to: u32,
    bytes: usize,
}

/// A full batch after its first tick, without its fabric.
#[derive(Clone, Debug, Serialize)]
struct BatchMemory {
    /// Vertices along each side.
    n: u32,
    lanes: usize,
    bytes: usize,
}

/// Counts the bytes of a flag's levels.
#[must_use]
pub fn run() -> Outcome {
    let cut: Vec<(Arc<Fabric>, usize)> =
        LEVELS.iter().map(|&n| held_by(|| product::fabric(&Scene::flag(n as usize)))).collect();
    let fabrics: Vec<FabricMemory> =
        LEVELS.iter().zip(&cut).map(|(&n, &(_, bytes))| FabricMemory { n, bytes }).collect();
    let transfers: Vec<TransferMemory> = cut
        .windows(2)
        .zip(LEVELS.windows(2))
        .map(|(fabrics, sizes)| {
            let between = || LevelTransfer::between(&fabrics[0].0, &fabrics[1].0);
            let (_transfer, bytes) = held_by(|| between().expect("levels of one flag"));
            TransferMemory { from: sizes[0], to: sizes[1], bytes }
        })
        .collect();
    let batches: Vec<BatchMemory> = LEVELS
        .iter()
        .zip(&cut)
        .flat_map(|(&n, (fabric, _))| {
            LaneCount::available().iter().map(move |&lanes| batch_memory(n, fabric, lanes))
        })
        .collect();
    Outcome {
        tables: vec![chain_table(&fabrics, &transfers), batch_table(&batches)],
        json: json!({ "fabrics": fabrics, "transfers": transfers, "batches": batches }),
        plots: Vec::new(),
    }
}

fn batch_memory(n: u32, fabric: &Arc<Fabric>, lanes: LaneCount) -> BatchMemory {
    let (_batch, bytes) = held_by(|| {
        let mut batch = ClothBatch::new(Arc::clone(fabric), lanes);
        let start = ClothSnapshot::at_rest(fabric);
        let material = product::material(&Scene::flag(n as usize));
        for _ in 0..lanes.get() {
            batch.insert(&start, material).expect("a free lane");
        }
        // The batch allocates the buffers of a step when they are first needed.
        batch.step(TICK, DEFAULT);
        batch
    });
    BatchMemory { n, lanes: lanes.get(), bytes }
}

fn kib(bytes: usize) -> String {
    format!("{:.1}", bytes as f64 / KIB)
}

fn chain_table(fabrics: &[FabricMemory], transfers: &[TransferMemory]) -> Table {
    let row = |what: String, bytes: usize| vec![what, kib(bytes)];
    let mut rows: Vec<Vec<String>> =
        fabrics.iter().map(|it| row(format!("fabric {n} × {n}", n = it.n), it.bytes)).collect();
    rows.extend(
        transfers.iter().map(|it| row(format!("transfer {} ↔ {}", it.from, it.to), it.bytes)),
    );
    let fabrics = fabrics.iter().map(|it| it.bytes).sum::<usize>();
    let transfers = transfers.iter().map(|it| it.bytes).sum::<usize>();
    rows.push(row("whole chain, once for all cloths of the mesh".into(), fabrics + transfers));
    Table {
        name: "memory_chain".into(),
        title: "What the cloths of one mesh share, on the heap".into(),
        headers: vec!["part", "KiB"],
        rows,
    }
}

fn batch_table(batches: &[BatchMemory]) -> Table {
    let cells = |it: &BatchMemory| {
        let particles = (it.n * it.n) as usize * it.lanes;
        vec![
            it.n.to_string(),
            it.lanes.to_string(),
            kib(it.bytes),
            kib(it.bytes / it.lanes),
            format!("{:.0}", it.bytes as f64 / particles as f64),
        ]
    };
    Table {
        name: "memory_batches".into(),
        title: "Full batches after their first tick, on the heap, without fabrics".into(),
        headers: vec!["n", "lanes", "KiB", "KiB a cloth", "bytes a particle"],
        rows: batches.iter().map(cells).collect(),
    }
}
