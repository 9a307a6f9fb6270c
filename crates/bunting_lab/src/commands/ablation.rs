//! What each part of the model costs and buys.

use bunting_solver::{Collider, LaneCount, StepSettings};
use glam::{Quat, Vec3};
use parry3d::shape::SharedShape;
use serde::Serialize;

use crate::{
    observation::{COMPARED_TICKS, Observer},
    output::table::{Table, figure, figure_or_dash},
    product::{Cloth, Product},
    reference::{Reference, grid::Grid},
    scenes::{Air, Scene},
    simulation::Simulation,
    timing::Timing,
};

/// The product as users meet it, eight cloths at once.
const WHOLE: Product = Product { settings: StepSettings::yarns(3), lanes: LaneCount::Eight };
/// Runs of the same scene: time is their median over all ticks.
const REPEATS: usize = 5;
/// Entry of `COMPARED_TICKS` that the error is taken at: 0.4 s.
const COMPARED: usize = 1;
/// A stiffness as good as none, N/m.
const NEXT_TO_NONE: f64 = 1e-3;

/// The model without one of its parts, or with one more.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// What was left out or added.
    part: &'static str,
    /// Microseconds a cloth and tick.
    us_per_cloth_tick: f64,
    /// That over the whole model's.
    us_ratio: f64,
    /// Distance at 0.4 s from the reference of the whole model, m RMS.
    rms_error_m: Option<f64>,
}

/// A change of the scene before the start, and one of the cloth after it.
struct Variant {
    part: &'static str,
    scene: fn(&mut Scene),
    cloth: fn(&mut Cloth),
}

const VARIANTS: [Variant; 7] = [
    Variant { part: "whole model", scene: |_| (), cloth: |_| () },
    Variant { part: "no shear", scene: |scene| scene.fabric.shear = NEXT_TO_NONE, cloth: |_| () },
    Variant { part: "no bending", scene: |scene| scene.fabric.bending = 0.0, cloth: |_| () },
    Variant { part: "no skin friction", scene: |scene| scene.air.friction = 0.0, cloth: |_| () },
    Variant { part: "no air", scene: |scene| scene.air = Air::VACUUM, cloth: |_| () },
    Variant { part: "no normals", scene: |_| (), cloth: |cloth| cloth.normals = false },
    Variant { part: "a ball nearby", scene: |_| (), cloth: near_a_ball },
];

/// A ball that the cloth passes without touching it.
fn near_a_ball(cloth: &mut Cloth) {
    let ball = Collider::fixed(SharedShape::ball(0.1), Vec3::new(0.5, 0.2, 0.5), Quat::IDENTITY);
    cloth.touch(&[ball]);
}

/// The swing in air, n × n: every part of the model acts.
fn scene(n: usize) -> Scene {
    Scene { air: Air { pressure: 0.6, friction: 0.02, ..Air::VACUUM }, ..Scene::swing(n) }
}

/// Measures every variant.
#[must_use]
pub fn rows(n: usize) -> Vec<Row> {
    let whole = scene(n);
    let reference = Reference::of(&whole);
    let mut rows: Vec<Row> = Vec::new();
    for variant in &VARIANTS {
        let (time, rms_error_m) = measure(&whole, variant, &reference);
        let us_per_cloth_tick = time / WHOLE.lanes.get() as f64;
        let base = rows.first().map_or(us_per_cloth_tick, |row| row.us_per_cloth_tick);
        let us_ratio = us_per_cloth_tick / base;
        rows.push(Row { part: variant.part, us_per_cloth_tick, us_ratio, rms_error_m });
    }
    rows
}

/// Median time of a tick, µs, and the error at 0.4 s, m RMS.
fn measure(whole: &Scene, variant: &Variant, reference: &Reference) -> (f64, Option<f64>) {
    let mut changed = whole.clone();
    (variant.scene)(&mut changed);
    let grid = Grid::new(whole);
    let (mut time, mut error) = (Timing::default(), None);
    for _ in 0..REPEATS {
        let mut cloth = WHOLE.start(&changed);
        (variant.cloth)(&mut cloth);
        let mut observer = Observer::new(whole, &grid);
        for _ in 0..COMPARED_TICKS[COMPARED] {
            time.time(|| cloth.tick());
            let double =
                |vectors: &[Vec3]| vectors.iter().map(|x| x.as_dvec3()).collect::<Vec<_>>();
            observer.observe(&double(cloth.positions()), &double(cloth.velocities()));
        }
        error = observer.finish().rms_error(&reference.observation, COMPARED);
    }
    (time.median(), error)
}

/// The rows for reading.
#[must_use]
pub fn table(n: usize, rows: &[Row]) -> Table {
    Table {
        name: format!("ablation_{n}"),
        title: format!(
            "Parts of the model on the swing in air, {n} × {n}, {WHOLE}, eight lanes; tethers and polish have no switch"
        ),
        headers: vec!["part", "µs/tick", "of the whole", "RMS error m"],
        rows: rows
            .iter()
            .map(|row| {
                vec![
                    row.part.into(),
                    figure(row.us_per_cloth_tick),
                    figure(row.us_ratio),
                    figure_or_dash(row.rms_error_m),
                ]
            })
            .collect(),
    }
}
