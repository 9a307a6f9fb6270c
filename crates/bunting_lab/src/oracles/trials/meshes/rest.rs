//! Meshes at rest: hung from an edge, from a rim and by two corners, and clamped level.

use std::{
    f32::consts::{FRAC_PI_4, PI, TAU},
    f64::consts::FRAC_PI_2,
};

use bunting_solver::{Drive, FabricBuilder, FabricMaterial};
use glam::{DVec2, Vec3};

use super::cloth::Cloth;
use super::limits::{REST, bound};
use super::materials::{ISOTROPIC, STANDARD};
use super::square::{ROUNDING, at_bottom, at_top, square};
use crate::{
    meshes::{Sheet, Triangulation, net},
    oracles::{
        Case,
        bending::Cantilever,
        stretch::{hung_funnel, hung_strip},
    },
    scenes::GRAVITY,
    stats::mean,
};

/// Error of a stretch that passes: of isotropic materials, and of others.
const STRETCH: [f64; 2] = [0.03, 0.05];
/// Error of a cantilever that passes.
const DROOP: f64 = 0.05;
/// Radius of the arc without texture, m.
const ARC_RADIUS: f32 = 0.3;
/// Part of its width that the tapered sheet loses over its height. Larger: stress is not along the height.
const TAPER: f64 = 0.2;
/// Part of its width that a pennant loses.
const POINTED: f64 = 0.95;
/// Radii of the rims of a funnel of a metre's height, m.
const FUNNEL: [f32; 2] = [0.4, 0.1];
/// Isotropic but for shear, and ten times as soft.
const SOFT: FabricMaterial =
    FabricMaterial { warp_stiffness: 1e3, weft_stiffness: 1e3, shear_stiffness: 50.0, ..ISOTROPIC };
/// Isotropic, and five times as soft.
const ELASTIC: FabricMaterial =
    FabricMaterial { warp_stiffness: 2e3, weft_stiffness: 2e3, shear_stiffness: 1e3, ..ISOTROPIC };
/// Time after which a cloth that hangs by two corners is at rest, s. After 10 s grids, too, still move in one of five starts:
/// they leave a near equilibrium.
const SETTLED: f64 = 20.0;
/// Γ = σgL³/B of the strips whose warp is turned.
const TURNED_GAMMA: f64 = 10.0;

/// All that is at rest.
pub(super) fn cases(triangulation: Triangulation) -> Vec<Case> {
    let mut cases = Vec::new();
    for n in [17, 33] {
        cases.extend(hung(triangulation, n));
    }
    // Delaunay triangulation of as many points takes seconds.
    if triangulation != Triangulation::Delaunay {
        cases.extend(hung(triangulation, 65));
    }
    cases.extend([1.0, 10.0, 50.0].map(|gamma| cantilever(triangulation, gamma)));
    cases.push(turned_cantilever(triangulation));
    cases.extend(two_corners(triangulation));
    cases.extend(cylinder(triangulation));
    cases.extend(without_chart(triangulation));
    cases.extend(tapered(triangulation, TAPER, ISOTROPIC));
    cases.extend(tapered(triangulation, POINTED, ELASTIC));
    cases
        .extend([ISOTROPIC, SOFT].into_iter().flat_map(|material| funnel(triangulation, material)));
    cases
}

/// δ/L of a square that hangs from an edge along its weft, its warp, and at 45° to both.
fn hung(triangulation: Triangulation, n: usize) -> Vec<Case> {
    let stiff_warp = FabricMaterial { weft_stiffness: 1e3, shear_stiffness: 200.0, ..ISOTROPIC };
    let stiff_weft = FabricMaterial { warp_stiffness: 1e3, shear_stiffness: 200.0, ..ISOTROPIC };
    let quarter = FRAC_PI_2 as f32;
    let sheet = Sheet::new(triangulation, [n, n], DVec2::ONE, 1);
    let trials = [
        ("isotropic, weft", 0.0, ISOTROPIC, 1e4, STRETCH[0]),
        ("isotropic, warp", quarter, ISOTROPIC, 1e4, STRETCH[0]),
        ("isotropic, 45°", FRAC_PI_4, ISOTROPIC, 1e4, STRETCH[0]),
        ("10 : 1, soft", 0.0, stiff_warp, 1e3, STRETCH[1]),
        ("1 : 10, stiff", 0.0, stiff_weft, 1e4, STRETCH[1]),
        // One over Young's modulus at 45° is ¼ (1/Y₁ + 1/Y₂ + 1/G).
        ("G = Y/50, 45°", FRAC_PI_4, STANDARD, 4.0 / (2e-4 + 5e-3), STRETCH[1]),
    ];
    let case =
        |(name, warp, material, stiffness, tolerance): (_, f32, FabricMaterial, f64, f64)| {
            let mut cloth = Cloth::new(sheet.fabric(warp, at_top), material, |at| at);
            cloth.run(4.0);
            Case::new(
                format!("mesh hung from an edge, {triangulation:?}, {name}, n = {}", n * n),
                hung_strip(f64::from(material.area_density), GRAVITY, 1.0, stiffness),
                -1.0 - cloth.mean(at_bottom).y,
                tolerance,
            )
        };
    trials.map(case).to_vec()
}

/// δ/L of a cylinder of a square metre with a seam of its texture that hangs from its rim, and its speed at rest.
fn cylinder(triangulation: Triangulation) -> [Case; 2] {
    let sheet = Sheet::new(triangulation, [33, 33], DVec2::ONE, 1);
    let mut cloth = Cloth::new(sheet.rolled_up(at_top), ISOTROPIC, |at| at);
    cloth.run(4.0);
    let stretch = -1.0 - cloth.mean(at_bottom).y;
    let expected = hung_strip(f64::from(ISOTROPIC.area_density), GRAVITY, 1.0, 1e4);
    let name = format!("cylinder with a seam, hung from its rim, {triangulation:?}");
    let speed = cloth.speed();
    [
        Case::new(name.clone(), expected, stretch, STRETCH[0]),
        bound(format!("{name}, speed at rest, m/s"), REST[0], speed),
    ]
}

/// δ/L of meshes whose textures do not say how they lie in the plane, hung from their tops, of a cloth that stretches by a
/// thousandth, and their speeds at rest: an arc without texture, two pieces whose warps are at right angles, and a sheet with a
/// slit.
fn without_chart(triangulation: Triangulation) -> [Case; 6] {
    let material = SOFT;
    let sheet = Sheet::new(triangulation, [33, 33], DVec2::ONE, 1);
    let arc = FabricBuilder::new(sheet.bent(ARC_RADIUS), sheet.indices.clone());
    let arc = net(&arc.pin_where(|at, _| at_top(at)));
    let expected = hung_strip(f64::from(material.area_density), GRAVITY, 1.0, 1e3);
    let of_cloth = |(name, fabric)| {
        let mut cloth = Cloth::new(fabric, material, |at| at);
        cloth.run(4.0);
        let stretch = -1.0 - cloth.mean(at_bottom).y;
        let name = format!("{name}, hung from its top, {triangulation:?}");
        let speed = cloth.speed();
        [
            Case::new(name.clone(), expected, stretch, STRETCH[1]),
            bound(format!("{name}, speed at rest, m/s"), REST[0], speed),
        ]
    };
    let [[a, b], [c, d], [e, f]] = [
        ("arc without texture", arc),
        ("two pieces", sheet.of_two_pieces(at_top)),
        ("sheet with a slit", sheet.with_slit().fabric(0.0, at_top)),
    ]
    .map(of_cloth);
    [a, b, c, d, e, f]
}

/// δ/L of a sheet that is half a metre wide at its top, from which it hangs, and narrower below by a part, and its speed at
/// rest.
fn tapered(triangulation: Triangulation, taper: f64, material: FabricMaterial) -> [Case; 2] {
    let size = DVec2::new(0.5, 1.0);
    let mut sheet = Sheet::new(triangulation, [17, 33], size, 1);
    for at in &mut sheet.positions {
        let narrower = 1.0 + taper as f32 * at.y;
        at.x = (at.x - 0.25) * narrower;
    }
    let fabric = sheet.fabric(0.0, at_top);
    let mut cloth = Cloth::new(fabric, material, |at| at);
    cloth.run(4.0);
    let stretch = -1.0 - cloth.mean(at_bottom).y;
    // At a depth of y of a sheet of width w₀ (1 − t y) hang σ g w₀ ((1 − y) − t (1 − y²)/2), on that width.
    let strain = |y: f64| ((1.0 - y) - 0.5 * taper * (1.0 - y * y)) / (1.0 - taper * y);
    let strains: Vec<f64> =
        (0..1000).map(|part| strain((f64::from(part) + 0.5) / 1000.0)).collect();
    let stiffness = f64::from(material.warp_stiffness);
    let expected = f64::from(material.area_density) * GRAVITY / stiffness * mean(&strains);
    let shape = if taper < 0.5 { "tapered sheet" } else { "pennant" };
    let name = format!("{shape}, hung from its top, {triangulation:?}");
    let speed = cloth.speed();
    [
        Case::new(name.clone(), expected, stretch, STRETCH[0]),
        bound(format!("{name}, speed at rest, m/s"), REST[0], speed),
    ]
}

/// How far the lower rim of a funnel sinks that hangs from its wider one, m, and its speed at rest.
fn funnel(triangulation: Triangulation, material: FabricMaterial) -> [Case; 2] {
    let sheet = Sheet::new(triangulation, [33, 33], DVec2::ONE, 1);
    let [upper, lower] = FUNNEL;
    let roll = |at: &Vec3| {
        let (sin, cos) = (TAU * at.x).sin_cos();
        let radius = upper + (lower - upper) * -at.y;
        Vec3::new(radius * sin, at.y, radius * cos)
    };
    let positions = sheet.positions.iter().map(roll).collect();
    let mesh = FabricBuilder::new(positions, sheet.indices).weld_distance(1e-5);
    let fabric = net(&mesh.pin_where(|at, _| at_top(at)));
    let mut cloth = Cloth::new(fabric, material, |at| at);
    cloth.run(4.0);
    let stiffness = f64::from(material.warp_stiffness);
    let density = f64::from(material.area_density);
    let expected = hung_funnel(density, GRAVITY, FUNNEL.map(f64::from), 1.0, stiffness);
    let sunk = -1.0 - cloth.mean(at_bottom).y;
    let name = format!("funnel, hung from its wide rim, {triangulation:?}, Y = {stiffness} N/m");
    let speed = cloth.speed();
    [
        Case::new(name.clone(), expected, sunk, STRETCH[0]),
        bound(format!("{name}, speed at rest, m/s"), REST[0], speed),
    ]
}

/// Drop over reach of a strip of 1 m × 0.25 m, clamped by one more cell, whose warp runs at an angle to it, rad.
fn droop(triangulation: Triangulation, gamma: f64, warp: f32) -> f64 {
    const CELL: f64 = 1.0 / 32.0;
    let sheet = Sheet::new(triangulation, [34, 9], DVec2::new(1.0 + CELL, 8.0 * CELL), 2);
    let fabric = sheet.fabric(warp, |at| f64::from(at.x) < 1.001 * CELL);
    let bend = f64::from(STANDARD.area_density) * GRAVITY / gamma;
    let material = FabricMaterial { bend_stiffness: bend as f32, ..STANDARD };
    let mut cloth = Cloth::new(fabric, material, |at| Vec3::new(at.x, 0.0, at.y));
    // Gravity is raised from nothing, as other equilibria exist.
    for tick in 1..=600 {
        let gravity = Vec3::NEG_Y * (GRAVITY * f64::from(tick) / 600.0) as f32;
        cloth.drive(Drive { gravity, air_density: 0.0, ..Drive::default() });
        cloth.tick();
    }
    cloth.run(5.0);
    let last = (1.0 + CELL) as f32;
    let tip = cloth.mean(|at| at.x > last - ROUNDING);
    -tip.y / (tip.x - CELL)
}

/// Drop over reach of a strip whose warp runs along it.
fn cantilever(triangulation: Triangulation, gamma: f64) -> Case {
    Case::new(
        format!("mesh clamped level, {triangulation:?}, Γ = {gamma}"),
        Cantilever::new(gamma).aspect(),
        droop(triangulation, gamma, 0.0),
        DROOP,
    )
}

/// Drop over reach of that strip whose warp, of eight directions, makes it droop most wrongly.
fn turned_cantilever(triangulation: Triangulation) -> Case {
    let expected = Cantilever::new(TURNED_GAMMA).aspect();
    let directions = (0..8_u8).map(|eighth| f32::from(eighth) * PI / 8.0);
    let droops = directions.map(|warp| droop(triangulation, TURNED_GAMMA, warp));
    let error = |droop: &f64| (droop - expected).abs();
    let worst = droops.max_by(|a, b| error(a).total_cmp(&error(b))).expect("eight directions");
    let name = format!("mesh clamped level, {triangulation:?}, worst of eight directions of warp");
    Case::new(format!("{name}, Γ = {TURNED_GAMMA}"), expected, worst, DROOP)
}

/// How fast a cloth is that has hung by two corners for a while, and where, beside the grid.
fn two_corners(triangulation: Triangulation) -> [Case; 2] {
    let hang = |triangulation| {
        let corners = |at: Vec3| at.y == 0.0 && (at.x == 0.0 || at.x == 1.0);
        let ripple = |at: Vec3| at + Vec3::Z * 1e-3 * (5.0 * at.x + 3.0 * at.y).sin();
        let mut cloth = Cloth::new(square(triangulation, 33, 0.0, corners), STANDARD, ripple);
        cloth.run(SETTLED);
        (cloth.speed(), cloth.mean(|_| true))
    };
    let (speed, at) = hang(Some(triangulation));
    let (_, of_grid) = hang(None);
    let name = format!("mesh hung by two corners, {triangulation:?}");
    let height = (at.y - of_grid.y).abs();
    [
        bound(format!("{name}, speed at rest, m/s"), REST[0], speed),
        bound(format!("{name}, height against the grid's, m"), REST[1], height),
    ]
}
