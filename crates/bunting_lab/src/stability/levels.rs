//! Changes of level, independence of lanes and threads, and bad input.

use std::thread;

use bunting_solver::{
    ClothBatch, ClothSnapshot, FabricBuilder, FabricMaterial, Grid as RestGrid, LaneCount,
    LevelTransfer, has_fused_products, with_every_instruction_set,
};
use glam::{DVec3, Vec3};

use super::{
    case::HardCase,
    rig::{energy, start},
};
use crate::{
    levels::pops::{self, Pop},
    meshes::moebius,
    product::{DEFAULT, Product, TICK, fabric, material},
    reference::grid::Grid,
    scenes::{Scene, ticks},
    settings::LEVELS,
    simulation::Simulation,
    stats::worse,
};

/// All cases.
pub fn cases(quick: bool) -> Vec<HardCase> {
    let seconds = if quick { 2.0 } else { 10.0 };
    let mut cases = thrash(17, seconds).to_vec();
    let pop = pops::thrash(17, DEFAULT, seconds);
    cases.push(HardCase::new("LOD thrash: pop", 17, "pixels from 20 m", pop, 1.0));
    cases.extend(changes(if quick { 4 } else { 20 }));
    cases.push(determinism(9, if quick { 500 } else { 10_000 }));
    cases.push(instruction_sets(9, if quick { 100 } else { 2_000 }));
    cases.push(bad_input());
    cases.push(bad_neighbour());
    cases
}

/// Cases of a swing that changes its level in every tick.
fn thrash(n: usize, seconds: f64) -> [HardCase; 2] {
    let scenes = [Scene::swing(n), Scene::swing(n / 2 + 1)];
    let grids = scenes.each_ref().map(Grid::new);
    let fabrics = scenes.each_ref().map(fabric);
    let transfer = LevelTransfer::between(&fabrics[0], &fabrics[1]).expect("nested levels");
    let mut cloths = scenes.each_ref().map(start);
    let gravity = Vec3::NEG_Y * scenes[0].gravity as f32;
    let momentum = |level: usize, state: &ClothSnapshot| -> DVec3 {
        let moving = state.velocities.iter().zip(&grids[level].masses);
        moving.map(|(v, m)| v.as_dvec3() * *m).sum()
    };
    let (mut kicked, mut highest, mut level) = (0.0_f64, 0.0_f64, 0);
    for _ in 0..ticks(seconds) {
        cloths[level].tick();
        let state = cloths[level].batch.snapshot(0);
        let next = 1 - level;
        let material = material(&scenes[level]);
        let switched = if level == 0 {
            transfer.restrict(&state, &material, gravity)
        } else {
            transfer.prolong(&state, &material, gravity)
        };
        let (before, after) = (momentum(level, &state), momentum(next, &switched));
        if before.length() > 1e-3 {
            kicked = worse(kicked, (after - before).length() / before.length());
        }
        cloths[next].restore(&switched);
        level = next;
        highest = worse(highest, energy(&scenes[level], &grids[level], &cloths[level]));
    }
    [
        HardCase::new("LOD thrash: momentum", n, "change in a switch, of one", kicked, 1e-5),
        HardCase::new("LOD thrash: energy", n, "over the start, of the fall", highest, 0.01),
    ]
}

/// Cases of the visible effect of a flag's change to the next coarser level and back, at the distances where such
/// changes are observed, for 95 % of many flags, four at each moment: the greatest departure of one flag is chance.
fn changes(moments: usize) -> impl Iterator<Item = HardCase> {
    LEVELS.windows(2).map(move |sizes| {
        let [fine, coarse] = [sizes[0] as usize, sizes[1] as usize];
        let pop = [(fine, coarse), (coarse, fine)]
            .map(|(from, to)| Pop::of(from, to, DEFAULT, moments).p95_px)
            .into_iter()
            .fold(0.0, worse);
        let name = format!("LOD: pop to {coarse}² and back from {} m", pops::distance(fine));
        HardCase::new(name, fine, "pixels, 95 % of flags", pop, 1.0)
    })
}

/// Case of a flag alone, among eight and among sixteen, on this thread and on others: all must have the same
/// bits.
fn determinism(n: usize, ticks: usize) -> HardCase {
    let runs: Vec<ClothSnapshot> = thread::scope(|scope| {
        let lanes = LaneCount::available().iter().chain([&LaneCount::One]);
        let threads = lanes.map(|&lanes| scope.spawn(move || fly(n, lanes, ticks)));
        let threads: Vec<_> = threads.collect();
        threads.into_iter().map(|run| run.join().expect("a run")).collect()
    });
    HardCase::new(
        "determinism: lanes and threads",
        n,
        "vertices that differ",
        differing(&runs),
        0.0,
    )
}

/// Case of a flag with each instruction set of the machine that has a fused multiply-add: all must have the same bits.
fn instruction_sets(n: usize, ticks: usize) -> HardCase {
    let name = "determinism: instruction sets";
    let fly = || fly(n, LaneCount::Eight, ticks);
    let runs = with_every_instruction_set(|| has_fused_products().then(fly));
    let runs: Vec<_> = runs.into_iter().flatten().collect();
    if runs.len() < 2 {
        return HardCase::not_built(name, "vertices that differ", 0.0);
    }
    HardCase::new(name, n, "vertices that differ", differing(&runs), 0.0)
}

/// State of a flag after `ticks` ticks.
fn fly(n: usize, lanes: LaneCount, ticks: usize) -> ClothSnapshot {
    let mut cloth = Product { settings: DEFAULT, lanes }.start(&Scene::flag(n));
    (0..ticks).for_each(|_| cloth.tick());
    cloth.batch.snapshot(0)
}

/// Greatest number of vertices by which a state differs from the first.
fn differing(states: &[ClothSnapshot]) -> f64 {
    let bits = |x: &Vec3| x.to_array().map(f32::to_bits);
    let counts = states.iter().map(|state| {
        let pairs = state.positions.iter().zip(&states[0].positions);
        pairs.filter(|(one, other)| bits(one) != bits(other)).count()
    });
    counts.max().unwrap_or_default() as f64
}

/// Case of bad input, all of which must be refused with a typed error.
fn bad_input() -> HardCase {
    let corners = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
    let mut infinite = corners.clone();
    infinite[1].x = f32::NAN;
    let meshes = [
        FabricBuilder::new(infinite, vec![0, 1, 2]),
        FabricBuilder::new(Vec::new(), Vec::new()),
        FabricBuilder::new(corners.clone(), vec![0, 1, 3]),
        FabricBuilder::new(corners.clone(), vec![0, 1]),
        FabricBuilder::new(corners.clone(), vec![0, 1, 1]),
        FabricBuilder::new(corners, vec![0, 1, 2]).pin([7]),
        moebius(24, 8, 0.1),
        FabricBuilder::grid(RestGrid::new(1, 9, 1.0, 1.0)),
        FabricBuilder::grid(RestGrid::new(9, 9, f32::INFINITY, 1.0)),
    ];
    let accepted_meshes = meshes.into_iter().filter(|mesh| mesh.clone().build().is_ok()).count();
    let silk = FabricMaterial::SILK;
    let materials = [
        FabricMaterial { area_density: -1.0, ..silk },
        FabricMaterial { area_density: 0.0, ..silk },
        FabricMaterial { warp_stiffness: f32::NAN, ..silk },
        FabricMaterial { damping: f32::INFINITY, ..silk },
    ];
    let accepted_materials = materials.iter().filter(|bad| bad.validate().is_ok()).count();
    let worst = (accepted_meshes + accepted_materials) as f64;
    HardCase::new("bad input", 0, "bad inputs accepted", worst, 0.0)
}

/// Case of a refused cloth, which must leave the others in the batch unchanged.
fn bad_neighbour() -> HardCase {
    let scene = Scene::swing(5);
    let fabric = fabric(&scene);
    let good = ClothSnapshot::at_rest(&fabric);
    let mut bad = good.clone();
    bad.positions[3].y = f32::INFINITY;
    let mut batch = ClothBatch::new(fabric, LaneCount::Eight);
    batch.insert(&good, material(&scene)).expect("a good cloth");
    let accepted = f64::from(u8::from(batch.insert(&bad, material(&scene)).is_ok()));
    batch.step(TICK, DEFAULT);
    let broken = f64::from(u8::from(!batch.is_finite(0)));
    HardCase::new("bad cloth beside a good one", 5, "accepted or spread", accepted + broken, 0.0)
}
