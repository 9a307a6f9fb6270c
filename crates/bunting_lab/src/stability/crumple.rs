//! Crumpled and degenerate initial states.

use glam::{DVec3, Vec3, dvec3};

use super::{
    case::HardCase,
    rig::{REACH, RECOVERED, reach, speed, start, strain},
};
use crate::{
    scenes::{Pose, Scene},
    simulation::{Simulation, run},
    specimen::Specimen,
    stats::worse,
};

/// Largest RMS speed of a cloth that has recovered, m/s.
const AT_REST: f64 = 0.1;
/// Time to recover, s.
const SECONDS: f64 = 6.0;

/// All cases.
pub fn cases(quick: bool) -> Vec<HardCase> {
    let n = if quick { 9 } else { 17 };
    let mut cases = Vec::new();
    // Positions lie within a centimetre of the middle of the pinned edge, by a sequence without pattern.
    let crushed = |vertex: usize, _: DVec3| {
        let scatter = |k: f64| ((vertex as f64 * k).sin() * 1e4).fract() * 0.01;
        dvec3(0.5, 0.0, 0.0) + dvec3(scatter(12.9898), scatter(78.233), scatter(37.719))
    };
    cases.extend(recovers("crushed to 1 cm", n, crushed));
    cases.extend(recovers("inverted", n, |_, x| dvec3(x.x, -x.y, x.z)));
    cases.push(finite("all vertices coincide", n, |_| DVec3::ZERO));
    cases.push(finite("collapsed to a line", n, |x| dvec3(0.0, x.y, 0.0)));
    cases.push(finite(
        "a zero-length edge",
        n,
        |x| if x.x < 0.5 { x } else { dvec3(0.5, x.y, x.z) },
    ));
    cases.push(in_the_wind_plane(n));
    cases
}

/// Cases of a cloth held by its top edge that recovers from other initial positions.
fn recovers(name: &str, n: usize, start_at: impl Fn(usize, DVec3) -> DVec3) -> [HardCase; 2] {
    let scene = Scene::hang_top(n);
    let mut cloth = start(&scene);
    let at: Vec<DVec3> = scene
        .positions()
        .into_iter()
        .enumerate()
        .map(|(vertex, x)| if scene.is_pinned(vertex) { x } else { start_at(vertex, x) })
        .collect();
    cloth.place(&at, &vec![DVec3::ZERO; at.len()]);
    run(&mut cloth, SECONDS);
    let left = 100.0 * strain(&scene, &cloth).p95;
    [
        HardCase::new(
            format!("{name}: unfolds"),
            n,
            "95th percentile of strain, %",
            left,
            RECOVERED,
        ),
        HardCase::new(format!("{name}: calms down"), n, "RMS speed, m/s", speed(&cloth), AT_REST),
    ]
}

/// Case of a degenerate start of a free cloth in wind, which must stay finite and near.
fn finite(name: &str, n: usize, place: impl Fn(DVec3) -> DVec3) -> HardCase {
    let scene = Scene { air: Scene::flag(n).air, ..Scene::hang_top(n) };
    let mut cloth = start(&scene);
    let at: Vec<DVec3> = scene
        .positions()
        .into_iter()
        .enumerate()
        .map(|(vertex, x)| if scene.is_pinned(vertex) { x } else { place(x) })
        .collect();
    cloth.place(&at, &vec![DVec3::ZERO; at.len()]);
    run(&mut cloth, 1.0);
    HardCase::new(format!("degenerate: {name}"), n, "reach, m", reach(&cloth), REACH)
}

/// Case of a flat cloth along the wind, which must feel no pressure and divide by no zero.
fn in_the_wind_plane(n: usize) -> HardCase {
    let mut air = Scene::flag(n).air;
    air.gust = [0.0; 3];
    let scene = Scene { air, pose: Pose::Vertical, gravity: 0.0, ..Scene::flag(n) };
    let mut cloth = start(&scene);
    run(&mut cloth, 1.0);
    let worst = cloth.positions().iter().map(|x: &Vec3| x.z.abs().into()).fold(0.0, worse);
    HardCase::new("degenerate: flat in the wind plane", n, "off the plane, m", worst, 1e-3)
}
