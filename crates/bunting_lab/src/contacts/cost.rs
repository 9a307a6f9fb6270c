//! What contact costs: the time of a tick of a cloth that touches a shape over that of the same cloth that flies in wind like a
//! flag, in one run, each with the substeps that it needs.
//!
//! Both times are those of ticks that are repeated from the same states, in turn, and the least of the repetitions: other programs
//! on the machine only ever make a repetition longer.

use std::sync::Arc;
use std::time::Instant;

use bunting_solver::{
    ClothBatch, Collider, Drive, Fabric, FabricBuilder, FabricMaterial, Grid, LaneCount,
};
use glam::{Quat, Vec3};
use parry3d::shape::SharedShape;

use super::{
    rig::{GRAVITY, Trial, sheet},
    row::Row,
    shapes::blob,
};
use crate::product::TICK;

/// Times after which ticks are repeated, s: the first touch, and when the cloth lies.
const MOMENTS: [f32; 3] = [0.5, 1.0, 1.5];
/// Repetitions of each tick.
const REPETITIONS: usize = 6;
/// Half the side of the box, and radius of the ball, m.
const HALF: f32 = 0.25;
const RADIUS: f32 = 0.3;
/// Distance of sheets above a shape at the start, m.
const GAP: f32 = 0.01;

/// Wind in which cloth flies, m/s.
const WIND: Vec3 = Vec3::new(5.9, 0.3, 1.0);

/// A cloth, what it touches, and how much dearer that may be.
struct Touch {
    name: String,
    fabric: Arc<Fabric>,
    /// The same cloth, held by an edge where it is not held anyway.
    flag: Arc<Fabric>,
    gravity: Vec3,
    colliders: Vec<Collider>,
    lanes: LaneCount,
    /// Greatest ratio that passes.
    ratio: f64,
}

pub(super) fn rows(_: bool) -> Vec<Row> {
    let [ball, cuboid] = [SharedShape::ball(RADIUS), SharedShape::cuboid(HALF, HALF, HALF)];
    let on_corner = Quat::from_rotation_arc(Vec3::ONE.normalize(), Vec3::Z);
    let (corners, triangles) = blob();
    let highest = corners.iter().map(|at| at.z).fold(f32::MIN, f32::max);
    let blob = SharedShape::trimesh(corners, triangles).expect("a good mesh");
    let upright = Quat::IDENTITY;
    let on = |name, shape, turn, top, ratio| {
        Touch::of_sheet(name, Collider::fixed(shape, Vec3::ZERO, turn), top, ratio)
    };
    let on_ball = || on("sheet on a ball", ball.clone(), upright, RADIUS, 1.5);
    let touches = [
        on_ball(),
        Touch { lanes: LaneCount::Eight, ratio: 1.8, ..on_ball() },
        on_ball().with_features(),
        on("sheet on a box", cuboid.clone(), upright, HALF, 1.7),
        on("sheet on a box", cuboid.clone(), upright, HALF, 1.7).with_features(),
        on("sheet on a corner of a box", cuboid, on_corner, HALF * 3_f32.sqrt(), 2.0),
        on("sheet on a mesh of 224 triangles", blob, upright, highest, 2.5),
        curtain(),
        cape(),
    ];
    touches.iter().map(Touch::row).collect()
}

/// A curtain of two metres that hangs over a ball.
fn curtain() -> Touch {
    let middle = Vec3::new(1.0, -1.2, 0.0);
    let ball = Collider::fixed(SharedShape::ball(0.2), middle - 0.1 * Vec3::Z, Quat::IDENTITY);
    Touch::hung("curtain against a ball", Grid::new(33, 33, 2.0, 2.0), vec![ball], 1.4)
}

/// A cape on the back of a figure of eight capsules.
fn cape() -> Touch {
    let width = 0.6;
    // Ends of each capsule's axis and its radius, m; x from the middle of the body, z to its front.
    let parts = [
        ([Vec3::new(0.0, 0.25, 0.05), Vec3::new(0.0, 0.3, 0.05)], 0.1),
        ([Vec3::new(0.0, 0.0, 0.0), Vec3::new(0.0, -0.45, 0.0)], 0.16),
        ([Vec3::new(-0.2, 0.0, 0.0), Vec3::new(-0.3, -0.3, -0.05)], 0.05),
        ([Vec3::new(0.2, 0.0, 0.0), Vec3::new(0.3, -0.3, -0.05)], 0.05),
        ([Vec3::new(-0.1, -0.55, 0.0), Vec3::new(-0.12, -0.9, 0.05)], 0.09),
        ([Vec3::new(0.1, -0.55, 0.0), Vec3::new(0.12, -0.9, -0.07)], 0.09),
        ([Vec3::new(-0.12, -0.9, 0.05), Vec3::new(-0.12, -1.3, 0.0)], 0.06),
        ([Vec3::new(0.12, -0.9, -0.07), Vec3::new(0.12, -1.3, -0.1)], 0.06),
    ];
    let collar = Vec3::new(0.5 * width, 0.0, 0.17);
    let capsule = |([from, to], radius): ([Vec3; 2], f32)| {
        Collider::fixed(SharedShape::capsule(from, to, radius), collar, Quat::IDENTITY)
    };
    Touch::hung(
        "cape on eight capsules",
        Grid::new(20, 30, width, 1.1),
        parts.map(capsule).into(),
        1.8,
    )
}

impl Touch {
    /// A level sheet above the highest point of a shape, which is `top` m above its middle.
    fn of_sheet(name: &str, shape: Collider, top: f32, ratio: f64) -> Self {
        let middle = Vec3::new(0.5, -0.5, -top - GAP);
        let (_, turn) = shape.from;
        let collider = Collider::fixed(shape.shape, middle, turn);
        let grid = FabricBuilder::grid(Grid::new(33, 33, 1.0, 1.0));
        let flag = grid.pin_where(|at, _| at.x == 0.0).build().expect("a good grid");
        let fabrics = [sheet(33, 33, 1.0, 1.0), Arc::new(flag)];
        Self::new(name, fabrics, -GRAVITY * Vec3::Z, vec![collider], ratio)
    }

    /// A cloth that hangs by its top.
    fn hung(name: &str, grid: Grid, colliders: Vec<Collider>, ratio: f64) -> Self {
        let pinned = FabricBuilder::grid(grid).pin_where(|at, _| at.y == 0.0);
        let fabric = Arc::new(pinned.build().expect("a good grid"));
        let fabrics = [Arc::clone(&fabric), fabric];
        Self::new(name, fabrics, -GRAVITY * Vec3::Y, colliders, ratio)
    }

    /// A cloth that is alone, without features.
    fn new(
        name: &str,
        [fabric, flag]: [Arc<Fabric>; 2],
        gravity: Vec3,
        colliders: Vec<Collider>,
        ratio: f64,
    ) -> Self {
        let without = |collider| Collider { features: false, ..collider };
        let colliders = colliders.into_iter().map(without).collect();
        Self { name: name.into(), fabric, flag, gravity, colliders, lanes: LaneCount::One, ratio }
    }

    fn with_features(mut self) -> Self {
        self.colliders.iter_mut().for_each(|collider| collider.features = true);
        Self { name: format!("{}, features", self.name), ..self }
    }

    fn row(&self) -> Row {
        let still = Drive { gravity: self.gravity, ..Drive::default() };
        let in_wind = Drive { wind: WIND, gravity: -GRAVITY * Vec3::Y, ..still };
        let mut flying = Trial::new(&self.flag, FabricMaterial::COTTON, in_wind.gravity);
        flying.drive(in_wind);
        let mut touching = Trial::new(&self.fabric, FabricMaterial::COTTON, self.gravity);
        touching.drive(still);
        touching.touch(self.colliders.iter().cloned());
        let (mut sums, mut before) = ([0.0; 2], 0.0);
        for moment in MOMENTS {
            flying.run(moment - before);
            touching.run(moment - before);
            before = moment;
            let times = self.times([&flying, &touching]);
            sums = [sums[0] + times[0], sums[1] + times[1]];
        }
        let name = match self.lanes {
            LaneCount::One => format!("cost: {}", self.name),
            lanes => format!("cost: {}, {} lanes", self.name, lanes.get()),
        };
        let us = sums[1] / MOMENTS.len() as f64;
        Row::new(name, "times the time of flight", sums[1] / sums[0], self.ratio, us).of_times()
    }

    /// Least times of the next ticks of two cloths, in turn, µs.
    fn times(&self, trials: [&Trial; 2]) -> [f64; 2] {
        let mut ticks = trials.map(|trial| {
            let (batch, settings) = (self.batch(trial), trial.next_settings());
            move || {
                let mut batch = batch.clone();
                let start = Instant::now();
                batch.step(TICK, settings);
                start.elapsed().as_secs_f64() * 1e6
            }
        });
        let mut least = [f64::INFINITY; 2];
        for _ in 0..REPETITIONS {
            for (least, tick) in least.iter_mut().zip(&mut ticks) {
                *least = tick().min(*least);
            }
        }
        least
    }

    /// A batch full of cloths in the state of a trial.
    fn batch(&self, trial: &Trial) -> ClothBatch {
        let state = trial.batch.snapshot(0);
        let mut batch = ClothBatch::new(Arc::clone(trial.batch.fabric()), self.lanes);
        for lane in 0..self.lanes.get() {
            batch.insert(&state, trial.material).expect("a good cloth");
            batch.drive(lane, trial.drive).expect("a good drive");
            batch.set_colliders(lane, trial.colliders.iter().cloned()).expect("good colliders");
        }
        batch
    }
}
