//! The scenes; each runs different parts of the solver.

use std::{sync::Arc, time::Duration};

use bevy_app::App;
use bevy_bunting::{ClothPlugins, ClothSettings, ClothState};
use bevy_time::{Fixed, Time, TimePlugin, TimeUpdateStrategy};
use bevy_transform::TransformPlugin;
use bunting_solver::{
    ClothBatch, ClothSnapshot, Collider, Drive, Fabric, FabricBuilder, FabricMaterial, FrameMotion,
    Grid, LaneCount, LevelTransfer, StepSettings,
};
use glam::{Quat, Vec3, Vec3Swizzles};
use parry3d::shape::SharedShape;

use super::{figures::figures, hash::StateHash};
use crate::figure::Figure;
use crate::meshes::{ball_with_poles, net};
use crate::product::TICK;

/// Number of ticks between two states that are hashed.
const INTERVAL: u32 = 60;

/// Runs a scene for some ticks in a batch of this width.
pub type Run = fn(LaneCount, u32) -> SceneEnd;

/// What is left of a run.
#[derive(Clone, Debug)]
pub struct SceneEnd {
    /// Hash of the states.
    pub hash: u64,
    /// Figures of the hashed cloth at the end.
    pub figures: Vec<Figure>,
}

/// A scene.
#[derive(Clone, Copy, Debug)]
pub struct GoldenScene {
    pub name: &'static str,
    pub run: Run,
    /// Whether its batches run on the threads of a pool, which do not know of the instruction set that another thread has
    /// chosen.
    pub is_in_pool: bool,
}

/// Every scene.
pub const ALL: [GoldenScene; 10] = [
    alone("flag on a vehicle", flag_on_a_vehicle),
    alone("stiff sheet by two corners", stiff_sheet),
    alone("mesh with a hole in wind", mesh_in_wind),
    alone("bent mesh with a hole in wind", bent_mesh_in_wind),
    alone("mesh of two pieces in wind", two_pieces_in_wind),
    alone("closed mesh with a hole in wind", closed_mesh_in_wind),
    alone("ball of cloth in wind", ball_in_wind),
    alone("Gauss–Seidel curtain on a ball", gauss_seidel),
    alone("free sheet on a floor, level changes", free_sheet),
    GoldenScene { name: "eight flags through the plugin", run: plugin, is_in_pool: true },
];

/// A scene of batches that run on the calling thread.
const fn alone(name: &'static str, run: Run) -> GoldenScene {
    GoldenScene { name, run, is_in_pool: false }
}

/// The hashed cloth in the last lane of a batch, and a cloth with another material and wind in the first
/// lane.
struct Pair {
    batch: ClothBatch,
    lane: usize,
    settings: StepSettings,
    hash: StateHash,
}

impl Pair {
    fn new(
        fabric: &Arc<Fabric>,
        lanes: LaneCount,
        material: FabricMaterial,
        settings: StepSettings,
    ) -> Self {
        let mut batch = ClothBatch::new(Arc::clone(fabric), lanes);
        let lane = lanes.get() - 1;
        let start = ClothSnapshot::at_rest(fabric);
        batch.replace(0, &start, FabricMaterial::SILK).expect("a good material");
        batch.replace(lane, &start, material).expect("a good material");
        Self { batch, lane, settings, hash: StateHash::new() }
    }

    fn tick(&mut self, drive: Drive) {
        self.batch
            .drive(0, Drive { wind: Vec3::new(3.0, 1.0, -7.0), ..Drive::default() })
            .expect("a good drive");
        self.batch.drive(self.lane, drive).expect("a good drive");
        self.batch.step(TICK, self.settings);
    }

    fn hash(&mut self) {
        let mut vectors = Vec::new();
        let state = self.batch.snapshot(self.lane);
        self.hash.add(&state.positions);
        self.hash.add(&state.velocities);
        self.batch.copy_normals(self.lane, &mut vectors);
        self.hash.add(&vectors);
    }

    /// Runs the scene for `ticks` ticks, driven by `drive`.
    fn run(mut self, ticks: u32, drive: impl Fn(u32) -> Drive) -> SceneEnd {
        for tick in 0..ticks {
            self.tick(drive(tick));
            if (tick + 1).is_multiple_of(INTERVAL) {
                self.hash();
            }
        }
        self.end()
    }

    fn end(&self) -> SceneEnd {
        let state = self.batch.snapshot(self.lane);
        let figures = figures(self.batch.fabric(), &state.positions, &state.velocities);
        SceneEnd { hash: self.hash.value(), figures }
    }
}

/// Wind of about 6 m/s whose strength and direction change, m/s.
fn gusts(tick: u32) -> Vec3 {
    let time = tick as f32 * TICK;
    Vec3::new(6.0 + 1.5 * libm::sinf(3.1 * time), 0.3, 2.0 * libm::sinf(1.7 * time + 0.5))
}

fn yarns(substeps: u32, passes: u32) -> StepSettings {
    StepSettings { passes, ..StepSettings::yarns(substeps) }
}

fn flag_on_a_vehicle(lanes: LaneCount, ticks: u32) -> SceneEnd {
    let grid = FabricBuilder::grid(Grid::new(33, 23, 1.5, 1.0));
    let fabric = Arc::new(grid.pin_where(|_, uv| uv.x == 0.0).build().expect("a flag"));
    Pair::new(&fabric, lanes, FabricMaterial::FLAG_POLYESTER, StepSettings::default()).run(
        ticks,
        |tick| {
            let turn = 0.01 * libm::sinf(0.05 * tick as f32);
            let motion = FrameMotion {
                rotation: Quat::from_xyzw(0.0, libm::sinf(turn), 0.0, libm::cosf(turn)),
                translation: Vec3::new(0.02, 0.0, -0.15) * libm::sinf(0.02 * tick as f32),
            };
            Drive { motion, wind: gusts(tick), ..Drive::default() }
        },
    )
}

fn stiff_sheet(lanes: LaneCount, ticks: u32) -> SceneEnd {
    let grid = FabricBuilder::grid(Grid::new(17, 17, 1.0, 1.0)).pin([0, 16]);
    let fabric = Arc::new(grid.build().expect("a sheet"));
    let stiff = FabricMaterial { bend_stiffness: 0.05, ..FabricMaterial::COTTON };
    Pair::new(&fabric, lanes, stiff, yarns(3, 2)).run(ticks, |tick| {
        let wind = if tick < 200 { gusts(tick) } else { Vec3::ZERO };
        Drive { wind, ..Drive::default() }
    })
}

/// A sheet of plain triangles with a round hole.
fn holed_mesh() -> FabricBuilder {
    let grid = Grid::new(21, 17, 1.2, 1.0);
    let pattern = FabricBuilder::grid(grid);
    let all: Vec<Vec3> = pattern.positions().to_vec();
    let in_hole = |vertex: u32| all[vertex as usize].distance(Vec3::new(0.7, -0.5, 0.0)) < 0.2;
    let kept: Vec<u32> = pattern
        .indices()
        .chunks_exact(3)
        .filter(|corners| !corners.iter().any(|&corner| in_hole(corner)))
        .flatten()
        .copied()
        .collect();
    let mut used = kept.clone();
    used.sort_unstable();
    used.dedup();
    let place = |vertex: u32| used.binary_search(&vertex).expect("it is used") as u32;
    FabricBuilder::new(
        used.iter().map(|&vertex| all[vertex as usize]).collect(),
        kept.into_iter().map(place).collect(),
    )
    .pin_where(|at, _| at.x == 0.0)
}

fn mesh_in_wind(lanes: LaneCount, ticks: u32) -> SceneEnd {
    in_wind(holed_mesh(), lanes, ticks)
}

/// The same mesh on an arc.
fn bent_mesh_in_wind(lanes: LaneCount, ticks: u32) -> SceneEnd {
    let flat = holed_mesh();
    let around = |at: &Vec3| {
        let (sin, cos) = libm::sincosf(at.x / 0.5);
        Vec3::new(0.5 * sin, at.y, 0.5 * cos)
    };
    let positions = flat.positions().iter().map(around).collect();
    let bent = FabricBuilder::new(positions, flat.indices().to_vec());
    in_wind(bent.pin_where(|at, _| at.x == 0.0), lanes, ticks)
}

/// The same mesh of two pieces with warps at right angles.
fn two_pieces_in_wind(lanes: LaneCount, ticks: u32) -> SceneEnd {
    let whole = holed_mesh();
    let corners: Vec<Vec3> =
        whole.indices().iter().map(|&corner| whole.positions()[corner as usize]).collect();
    let uv = corners.chunks_exact(3).flat_map(|corners| {
        let is_left = corners.iter().map(|at| at.x).sum::<f32>() < 3.0 * 0.6;
        corners.iter().map(move |at| if is_left { at.xy() } else { at.yx() })
    });
    let pieces = FabricBuilder::new(corners.clone(), (0..corners.len() as u32).collect());
    in_wind(pieces.uv(uv.collect()).pin_where(|at, _| at.x == 0.0), lanes, ticks)
}

/// The same mesh rolled up until its sides meet.
fn closed_mesh_in_wind(lanes: LaneCount, ticks: u32) -> SceneEnd {
    let flat = holed_mesh();
    let radius = 1.2 / core::f32::consts::TAU;
    let around = |at: &Vec3| {
        let (sin, cos) = libm::sincosf(at.x / radius);
        Vec3::new(radius * sin, at.y, radius * cos)
    };
    let positions = flat.positions().iter().map(around).collect();
    let closed = FabricBuilder::new(positions, flat.indices().to_vec()).weld_distance(1e-4);
    in_wind(closed.pin_where(|at, _| at.y == 0.0), lanes, ticks)
}

/// A ball without any opening.
fn ball_in_wind(lanes: LaneCount, ticks: u32) -> SceneEnd {
    in_wind(ball_with_poles(24, 12, 0.4).pin_where(|at, _| at.y > 0.39), lanes, ticks)
}

fn in_wind(mesh: FabricBuilder, lanes: LaneCount, ticks: u32) -> SceneEnd {
    Pair::new(&net(&mesh), lanes, FabricMaterial::COTTON, yarns(3, 2))
        .run(ticks, |tick| Drive { wind: gusts(tick), ..Drive::default() })
}

fn gauss_seidel(lanes: LaneCount, ticks: u32) -> SceneEnd {
    let grid = FabricBuilder::grid(Grid::new(17, 13, 1.0, 1.0));
    let fabric = Arc::new(grid.pin_where(|_, uv| uv.y == 0.0).build().expect("a curtain"));
    let settings = StepSettings { passes: 2, ..StepSettings::gauss_seidel(5) };
    let mut pair = Pair::new(&fabric, lanes, FabricMaterial::DENIM, settings);
    let ball = Collider::fixed(SharedShape::ball(0.2), Vec3::new(0.5, -0.6, 0.1), Quat::IDENTITY);
    let ball = Collider { features: true, ..ball };
    pair.batch.set_colliders(pair.lane, [ball]).expect("good shapes");
    pair.run(ticks, |tick| Drive { wind: 0.5 * gusts(tick), ..Drive::default() })
}

fn free_sheet(lanes: LaneCount, ticks: u32) -> SceneEnd {
    let grid = FabricBuilder::grid(Grid::new(17, 17, 1.0, 1.0));
    let coarse =
        Arc::new(grid.coarser().expect("a coarser grid").builder.build().expect("a sheet"));
    let fine = Arc::new(grid.build().expect("a sheet"));
    let transfer = LevelTransfer::between(&fine, &coarse).expect("levels of a grid");
    let material = FabricMaterial { internal_damping: 1.0, ..FabricMaterial::FLAG_POLYESTER };
    let mut pair = Pair::new(&fine, lanes, material, yarns(2, 2));
    let mut other = Pair::new(&coarse, lanes, material, yarns(1, 2));
    let floor = Collider::fixed(
        SharedShape::cuboid(2.0, 0.1, 2.0),
        Vec3::new(0.5, -1.6, 0.0),
        Quat::IDENTITY,
    );
    let post = Collider::fixed(
        SharedShape::capsule_y(0.3, 0.1),
        Vec3::new(0.5, -1.2, 0.05),
        Quat::IDENTITY,
    );
    let [floor, post] = [floor, post].map(|it| Collider { features: true, ..it });
    let gravity = Drive::default().gravity;
    for it in [&mut pair, &mut other] {
        it.batch.set_colliders(it.lane, [floor.clone(), post.clone()]).expect("good shapes");
    }
    for tick in 0..ticks {
        if tick == 150 || tick == 450 {
            let state = transfer.restrict(&pair.batch.snapshot(pair.lane), &material, gravity);
            other.batch.restore(other.lane, &state).expect("a state of the coarser level");
        }
        if tick == 300 {
            let state = transfer.prolong(&other.batch.snapshot(other.lane), &material, gravity);
            pair.batch.restore(pair.lane, &state).expect("a state of the finer level");
        }
        for it in [&mut pair, &mut other] {
            it.tick(Drive { wind: 0.3 * gusts(tick), ..Drive::default() });
            if (tick + 1).is_multiple_of(INTERVAL) {
                it.hash();
            }
        }
    }
    pair.hash.add(&other.batch.snapshot(other.lane).positions);
    pair.end()
}

/// The scene of the example `flags`.
const FLAGS: &str = include_str!("../../../../assets/scenes/flags.ron");

fn plugin(lanes: LaneCount, ticks: u32) -> SceneEnd {
    let scene = bunting_scenes::parse(FLAGS, "flags.ron".as_ref()).expect("a good scene");
    let tick = Duration::from_secs_f32(TICK);
    let mut app = App::new();
    app.add_plugins((TimePlugin, TransformPlugin, ClothPlugins::default()))
        .insert_resource(Time::<Fixed>::from_duration(tick))
        .insert_resource(TimeUpdateStrategy::ManualDuration(tick))
        .insert_resource(ClothSettings { lanes: Some(lanes), ..ClothSettings::default() })
        .add_systems(bevy_app::FixedUpdate, bunting_scenes::follow_tracks);
    bunting_scenes::spawn(&mut app.world_mut().commands(), &scene);
    app.finish();
    app.cleanup();
    let mut hash = StateHash::new();
    for update in 1..=ticks {
        app.update();
        if update.is_multiple_of(INTERVAL) {
            let world = app.world_mut();
            let mut states: Vec<_> =
                world.query::<(bevy_ecs::entity::Entity, &ClothState)>().iter(world).collect();
            states.sort_unstable_by_key(|(entity, _)| *entity);
            for (_, state) in states {
                hash.add(state.positions());
                hash.add(state.normals());
            }
        }
    }
    // The figures are those of the first flag.
    let world = app.world_mut();
    let mut states = world.query::<(bevy_ecs::entity::Entity, &ClothState)>();
    let first = states.iter(world).min_by_key(|(entity, _)| *entity);
    let (_, state) = first.expect("eight flags");
    let pairs = state.positions().iter().zip(state.previous_positions());
    let velocities: Vec<Vec3> = pairs.map(|(now, before)| (*now - *before) / TICK).collect();
    let fabric = state.fabric().expect("a flag that is built");
    let figures = figures(fabric, state.positions(), &velocities);
    SceneEnd { hash: hash.value(), figures }
}
