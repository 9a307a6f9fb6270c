//! Cost and benefit of each part of the model.

use std::sync::Arc;

use bunting_solver::{Collider, FabricBuilder, LaneCount, StepSettings};
use glam::{Quat, Vec3};
use parry3d::shape::SharedShape;
use serde::Serialize;

use crate::{
    observation::{Observation, Observer},
    output::table::{Table, figure, figure_or_dash},
    product::{self, Cloth, DEFAULT, Product},
    reference::{Reference, grid::Grid},
    scenes::{Air, Scene},
    simulation::{Simulation, in_double},
    timing::Timing,
};

/// Cloths advanced at once.
const LANES: LaneCount = LaneCount::Eight;
/// Entry of `COMPARED_TICKS` at which the error is taken: 0.4 s.
const COMPARED: usize = 1;
/// A stiffness that has no visible effect, N/m.
const NEXT_TO_NONE: f64 = 1e-3;
/// Skin friction of the air, ρ C_t, kg/m³.
const FRICTION: f64 = 0.02;

/// The model without one of its parts, or with one more.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Part that was left out or added.
    part: &'static str,
    /// Microseconds a cloth and tick, of a flag in the wind.
    us_per_cloth_tick: f64,
    /// Time divided by the whole model's.
    us_ratio: f64,
    /// Distance of the swing in air at 0.4 s from the reference of the whole model, m RMS.
    rms_error_m: Option<f64>,
    /// Distance of the mean strain of the cloth hung by its corners from the mean strain of the whole model's
    /// reference.
    strain_error: f64,
    /// 99.9th percentile of the strain of the flag's warp and weft.
    flag_strain_p999: f64,
}

/// A change of the scene, of its fabric, of the settings, and of the cloth.
struct Variant {
    part: &'static str,
    scene: fn(&mut Scene),
    cut: fn(FabricBuilder) -> FabricBuilder,
    settings: StepSettings,
    cloth: fn(&mut Cloth),
}

/// The whole model.
const WHOLE: Variant = Variant {
    part: "whole model",
    scene: |_| (),
    cut: |pattern| pattern,
    settings: DEFAULT,
    cloth: |_| (),
};

const VARIANTS: [Variant; 9] = [
    WHOLE,
    Variant { part: "limp shear", scene: |scene| scene.fabric.shear = NEXT_TO_NONE, ..WHOLE },
    Variant { part: "limp bending", scene: |scene| scene.fabric.bending = 0.0, ..WHOLE },
    Variant { part: "no skin friction", scene: |scene| scene.air.friction = 0.0, ..WHOLE },
    Variant { part: "no air", scene: |scene| scene.air = Air::VACUUM, ..WHOLE },
    Variant { part: "no tethers", cut: |pattern| pattern.tethered(false), ..WHOLE },
    Variant { part: "one pass", settings: StepSettings { passes: 1, ..DEFAULT }, ..WHOLE },
    Variant { part: "no normals", cloth: |cloth| cloth.normals = false, ..WHOLE },
    Variant { part: "a ball nearby", cloth: near_a_ball, ..WHOLE },
];

/// Puts a ball beside the cloth that few of its particles may touch.
fn near_a_ball(cloth: &mut Cloth) {
    let ball = Collider::fixed(SharedShape::ball(0.1), Vec3::new(0.5, 0.2, 0.5), Quat::IDENTITY);
    cloth.touch(&[ball]);
}

/// The swing and the flag, n × n, in air with skin friction: every part of the model acts.
fn scenes(n: usize) -> [Scene; 2] {
    let air = Air { pressure: 0.6, ..Air::VACUUM };
    let swing = Scene { air, ..Scene::swing(n) };
    [swing, Scene::flag(n)].map(|mut scene| {
        scene.air.friction = FRICTION;
        scene
    })
}

/// Measures every variant.
#[must_use]
pub fn rows(n: usize) -> Vec<Row> {
    let [swing, flag] = scenes(n);
    let corners = Scene::hang_corners(n);
    let [swing_reference, corners_reference] =
        [&swing, &corners].map(|scene| Reference::of(scene).observation);
    let mut rows: Vec<Row> = Vec::new();
    for variant in &VARIANTS {
        let (flown, time) = run(&flag, variant);
        let us_per_cloth_tick = time.median() / LANES.get() as f64;
        let whole = rows.first().map_or(us_per_cloth_tick, |row| row.us_per_cloth_tick);
        rows.push(Row {
            part: variant.part,
            us_per_cloth_tick,
            us_ratio: us_per_cloth_tick / whole,
            rms_error_m: run(&swing, variant).0.rms_error(&swing_reference, COMPARED),
            strain_error: (run(&corners, variant).0.strain.mean - corners_reference.strain.mean)
                .abs(),
            flag_strain_p999: flown.strain.p999,
        });
    }
    rows
}

/// Observation of a scene under a variant, and the time of its ticks, of all lanes.
fn run(scene: &Scene, variant: &Variant) -> (Observation, Timing) {
    let mut changed = scene.clone();
    (variant.scene)(&mut changed);
    let fabric = (variant.cut)(product::pattern(&changed)).build().expect("a scene is a good grid");
    let product = Product { settings: variant.settings, lanes: LANES };
    let mut cloth = product.start_cut(Arc::new(fabric), &changed);
    (variant.cloth)(&mut cloth);
    let grid = Grid::new(scene);
    let mut observer = Observer::new(scene, &grid);
    let mut time = Timing::default();
    for _ in 0..scene.ticks() {
        time.time(|| cloth.tick());
        observer.observe(&in_double(cloth.positions()), &in_double(cloth.velocities()));
    }
    (observer.finish(), time)
}

/// The rows as a table.
#[must_use]
pub fn table(n: usize, rows: &[Row]) -> Table {
    let StepSettings { substeps, passes, .. } = DEFAULT;
    Table {
        name: format!("ablation_{n}"),
        title: format!(
            "Parts of the model, {n} × {n}, {}, {substeps} × {passes}, eight lanes: time of a flag \
             in the wind, and errors against the whole model's references (shear and bending go limp, their time stays)",
            Product { settings: DEFAULT, lanes: LANES }
        ),
        headers: vec![
            "part",
            "µs/tick",
            "of the whole",
            "swing: RMS error m",
            "corners: strain error",
            "flag: 99.9 % strain",
        ],
        rows: rows
            .iter()
            .map(|row| {
                vec![
                    row.part.into(),
                    figure(row.us_per_cloth_tick),
                    figure(row.us_ratio),
                    figure_or_dash(row.rms_error_m),
                    figure(row.strain_error),
                    figure(row.flag_strain_p999),
                ]
            })
            .collect(),
    }
}
