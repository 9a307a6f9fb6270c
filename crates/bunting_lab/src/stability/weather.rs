//! Wind, weights, and a fabric that changes.

use super::{
    case::HardCase,
    rig::{REACH, reach, start},
};
use crate::{
    product::{DEFAULT, Product, material},
    reference::grid::Grid,
    scenes::{Air, Fabric, Pins, Pose, Scene, ticks},
    simulation::{Simulation, in_double, run},
    stats::worse,
};

/// Pressure coefficient times density of a flag, kg/m³.
const PRESSURE: f64 = 1.47;

/// All cases.
pub fn cases(quick: bool) -> Vec<HardCase> {
    let n = if quick { 9 } else { 33 };
    let seconds = if quick { 2.0 } else { 10.0 };
    let mut cases = Vec::new();
    for density in [0.02, 0.2, 2.0] {
        let worst = flag(n, density, 6.0, seconds);
        cases.push(HardCase::new(
            format!("light and heavy: {density} kg/m²"),
            n,
            "reach, m",
            worst,
            REACH,
        ));
    }
    cases.push(mass_ratio(n));
    cases.push(HardCase::new(
        "wind stepped to 40 m/s",
        n,
        "reach, m",
        flag(n, 0.2, 40.0, seconds),
        REACH,
    ));
    cases.push(HardCase::new(
        "20 m/s on 100 g/m²",
        n,
        "reach, m",
        flag(n, 0.1, 20.0, seconds),
        REACH,
    ));
    cases.push(overtaken());
    cases.push(stiffened(n));
    cases
}

/// Greatest reach of a flag that lies still when the wind sets in.
fn flag(n: usize, density: f64, wind: f64, seconds: f64) -> f64 {
    let flag = Scene::flag(n);
    let scene = Scene {
        fabric: Fabric { density, ..flag.fabric },
        air: Air { wind: [wind, 0.0, 0.0], pressure: PRESSURE, ..flag.air },
        ..flag
    };
    let mut cloth = start(&scene);
    (0..ticks(seconds)).fold(0.0, |worst: f64, _| {
        cloth.tick();
        worst.max(reach(&cloth))
    })
}

/// Case of cloths of 2 g/m² and 2 kg/m² side by side in one batch.
fn mass_ratio(n: usize) -> HardCase {
    let scene = Scene::flag(n);
    let product = Product { settings: DEFAULT, lanes: bunting_solver::LaneCount::Eight };
    let mut cloths = product.start(&scene);
    let weigh =
        |density| material(&Scene { fabric: Fabric { density, ..scene.fabric }, ..scene.clone() });
    for lane in 0..8 {
        let density = if lane == 0 { 0.002 } else { 2.0 };
        cloths.batch.set_material(lane, weigh(density)).expect("a good material");
    }
    let mut worst = 0.0_f64;
    for _ in 0..ticks(2.0) {
        cloths.tick();
        worst = worst.max(reach(&cloths));
    }
    HardCase::new("mass ratio 1 : 1000 in one batch", n, "reach of the light one, m", worst, REACH)
}

/// Case of a free sheet in a wind that sets in at 40 m/s, which the sheet must not overtake.
fn overtaken() -> HardCase {
    const WIND: f64 = 40.0;
    let scene = Scene {
        fabric: Fabric { density: 0.02, ..Fabric::STANDARD },
        air: Air { wind: [0.0, WIND, 0.0], pressure: PRESSURE, ..Air::VACUUM },
        pins: Pins::Free,
        pose: Pose::Horizontal,
        gravity: 0.0,
        ..Scene::swing(5)
    };
    let mut cloth = start(&scene);
    let worst = (0..30).fold(0.0, |worst, _| {
        cloth.tick();
        let speeds = cloth.velocities().iter().map(|v| f64::from(v.y));
        worse(worst, speeds.fold(0.0, worse) / WIND)
    });
    HardCase::new("wind never overtaken", 5, "speed over the wind's", worst, 1.0)
}

/// Case of a cloth at rest that becomes a hundred times as stiff.
fn stiffened(n: usize) -> HardCase {
    let hang = Scene::hang_corners(n);
    let scene =
        Scene { fabric: Fabric { stretch: [1e3, 1e3], shear: 20.0, ..hang.fabric }, ..hang };
    let mut cloth = start(&scene);
    run(&mut cloth, scene.seconds);
    cloth.change(|scene| {
        scene.fabric.stretch = [1e5, 1e5];
        scene.fabric.shear = 2e3;
    });
    let grid = Grid::new(&Scene {
        fabric: Fabric { stretch: [1e5, 1e5], shear: 2e3, ..scene.fabric },
        ..scene
    });
    let stored = grid.elastic_energy(&in_double(cloth.positions()));
    let worst = (0..60).fold(0.0, |worst, _| {
        cloth.tick();
        worse(worst, grid.kinetic_energy(&in_double(cloth.velocities())) / stored)
    });
    HardCase::new("stiffness × 100 in one frame", n, "kinetic over elastic energy", worst, 1.0)
}
