//! Meshes that are no grids, by default settings: closed forms where there are some; elsewhere bounds, and the grid of
//! as many particles, as this group asks whether a mesh is as good as a grid.

use std::{f32::consts::FRAC_PI_4, f64::consts::FRAC_PI_2, sync::Arc};

use bunting_solver::{
    ClothBatch, ClothSnapshot, Drive, Fabric, FabricBuilder, FabricMaterial, Grid, LaneCount,
    StepLimits,
};
use glam::{DVec2, DVec3, Vec3};

use crate::{
    meshes::{Sheet, Triangulation},
    oracles::{Case, bending::Cantilever, stretch::hung_strip},
    product::TICK,
    scenes::{GRAVITY, TICK_RATE},
    specimen::Mount,
    stats::mean,
};

/// Isotropic but for Poisson's ratio.
const ISOTROPIC: FabricMaterial = FabricMaterial {
    area_density: 0.2,
    warp_stiffness: 1e4,
    weft_stiffness: 1e4,
    shear_stiffness: 5e3,
    damping: 4.0,
    ..FabricMaterial::FLAG_POLYESTER
};
/// The fabric of the standard scenes.
const STANDARD: FabricMaterial = FabricMaterial { shear_stiffness: 200.0, ..ISOTROPIC };
/// Error of a stretch that passes: of isotropic materials, and of others.
const STRETCH: [f64; 2] = [0.03, 0.05];
/// Error of a cantilever that passes.
const DROOP: f64 = 0.05;
/// Speed at rest, m/s RMS, and distance from the grid at rest, m, that pass.
const REST: [f64; 2] = [1e-3, 5e-3];
/// Distance of the swing's mean from the grid's that passes, m, after 0.4 s.
const SWING: f64 = 5e-3;
/// How much more than the grid's a mesh's strain in wind may be.
const FLAG: f64 = 1.25;

/// Everything that a mesh should do as a grid does.
pub fn cases(_: &Mount) -> Vec<Case> {
    let mut cases = Vec::new();
    for triangulation in [Triangulation::Delaunay, Triangulation::Quads] {
        for n in [17, 33] {
            cases.extend(hung(triangulation, n));
        }
        cases.extend([1.0, 10.0, 50.0].map(|gamma| cantilever(triangulation, gamma)));
        cases.extend([swing(triangulation), flag(triangulation)]);
        cases.extend(two_corners(triangulation));
        cases.extend(cylinder(triangulation));
    }
    cases
}

/// A square metre of `n` × `n` particles, or the grid of as many.
fn square(
    triangulation: Option<Triangulation>,
    n: usize,
    warp: f32,
    is_pinned: fn(Vec3) -> bool,
) -> Arc<Fabric> {
    match triangulation {
        Some(triangulation) => {
            Sheet::new(triangulation, [n, n], DVec2::ONE, 1).fabric(warp, is_pinned)
        }
        None => {
            let grid = FabricBuilder::grid(Grid::new(n as u32, n as u32, 1.0, 1.0));
            Arc::new(grid.pin_where(|at, _| is_pinned(at)).build().expect("a cloth"))
        }
    }
}

fn at_top(at: Vec3) -> bool {
    at.y == 0.0
}

/// One cloth, and what it is driven by.
struct Cloth {
    fabric: Arc<Fabric>,
    batch: ClothBatch,
    positions: Vec<Vec3>,
}

impl Cloth {
    fn new(fabric: Arc<Fabric>, material: FabricMaterial, place: impl Fn(Vec3) -> Vec3) -> Self {
        let mut start = ClothSnapshot::at_rest(&fabric);
        start.positions.iter_mut().for_each(|at| *at = place(*at));
        let mut batch = ClothBatch::new(Arc::clone(&fabric), LaneCount::One);
        batch.insert(&start, material).expect("a lane");
        let mut cloth = Self { fabric, batch, positions: Vec::new() };
        cloth.drive(Drive { air_density: 0.0, ..Drive::default() });
        cloth
    }

    fn drive(&mut self, drive: Drive) {
        self.batch.drive(0, drive).expect("a lane");
    }

    fn tick(&mut self) {
        let settings = StepLimits::default().of_fabric(&self.fabric, TICK, GRAVITY as f32);
        self.batch.step(TICK, settings);
        self.batch.copy_positions(0, &mut self.positions);
    }

    fn run(&mut self, seconds: f64) {
        (0..(seconds * f64::from(TICK_RATE)) as usize).for_each(|_| self.tick());
    }

    /// Mean position of the particles that rest where `is_wanted` says, each counted as its area, m.
    fn mean(&self, is_wanted: impl Fn(Vec3) -> bool) -> DVec3 {
        let rest = self.fabric.rest_positions().iter().zip(self.fabric.particle_areas());
        let wanted = rest.zip(&self.positions).filter(|((rest, _), _)| is_wanted(**rest));
        let (sum, area) = wanted.fold((DVec3::ZERO, 0.0), |(sum, all), ((_, &area), at)| {
            (sum + at.as_dvec3() * f64::from(area), all + f64::from(area))
        });
        sum / area
    }

    /// Speed over a tick, m/s RMS.
    fn speed(&mut self) -> f64 {
        let before = self.positions.clone();
        self.tick();
        let moved =
            self.positions.iter().zip(&before).map(|(now, then)| now.distance_squared(*then));
        let squared: Vec<f64> = moved.map(f64::from).collect();
        mean(&squared).sqrt() * f64::from(TICK_RATE)
    }

    /// Mean change of length of the edges, relative.
    fn strain(&self) -> f64 {
        let sides = self.fabric.triangles().iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let length = |of: &[Vec3], [a, b]: [u32; 2]| of[a as usize].distance(of[b as usize]);
        let rest = self.fabric.rest_positions();
        let strains: Vec<f64> = sides
            .map(|ends| length(&self.positions, ends) / length(rest, ends) - 1.0)
            .map(|strain| f64::from(strain.abs()))
            .collect();
        mean(&strains)
    }
}

/// δ/L of a square that hangs from an edge along its weft, its warp, and at 45° to both.
fn hung(triangulation: Triangulation, n: usize) -> Vec<Case> {
    let stiff_warp = FabricMaterial { weft_stiffness: 1e3, shear_stiffness: 200.0, ..ISOTROPIC };
    let stiff_weft = FabricMaterial { warp_stiffness: 1e3, shear_stiffness: 200.0, ..ISOTROPIC };
    let quarter = FRAC_PI_2 as f32;
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
            let mut cloth =
                Cloth::new(square(Some(triangulation), n, warp, at_top), material, |at| at);
            cloth.run(4.0);
            Case::new(
                format!("mesh hung from an edge, {triangulation:?}, {name}, n = {}", n * n),
                hung_strip(f64::from(material.area_density), GRAVITY, 1.0, stiffness),
                -1.0 - cloth.mean(|at| at.y == -1.0).y,
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
    let stretch = -1.0 - cloth.mean(|at| at.y == -1.0).y;
    let expected = hung_strip(f64::from(ISOTROPIC.area_density), GRAVITY, 1.0, 1e4);
    let name = format!("cylinder with a seam, hung from its rim, {triangulation:?}");
    let speed = cloth.speed();
    [
        Case::new(name.clone(), expected, stretch, STRETCH[0]),
        bound(format!("{name}, speed at rest, m/s"), REST[0], speed),
    ]
}

/// Drop over reach of a strip of 1 m × 0.25 m, clamped by one more cell.
fn cantilever(triangulation: Triangulation, gamma: f64) -> Case {
    const CELL: f64 = 1.0 / 32.0;
    let sheet = Sheet::new(triangulation, [34, 9], DVec2::new(1.0 + CELL, 8.0 * CELL), 2);
    let fabric = sheet.fabric(0.0, |at| f64::from(at.x) < 1.001 * CELL);
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
    let tip = cloth.mean(|at| at.x > last - 1e-5);
    Case::new(
        format!("mesh clamped level, {triangulation:?}, Γ = {gamma}"),
        Cantilever::new(gamma).aspect(),
        -tip.y / (tip.x - CELL),
        DROOP,
    )
}

/// A measured size that must not exceed a limit.
fn bound(name: String, limit: f64, measured: f64) -> Case {
    let relative_error = measured / limit;
    let pass = relative_error <= 1.0;
    Case { name, expected: limit, measured, relative_error, tolerance: 1.0, pass }
}

/// Where the mean of a cloth is that swings from level by an edge, beside the grid's.
fn swing(triangulation: Triangulation) -> Case {
    let mean = |triangulation| {
        let fabric = square(triangulation, 33, 0.0, at_top);
        let material = FabricMaterial { damping: 0.0, ..STANDARD };
        let mut cloth = Cloth::new(fabric, material, |at| Vec3::new(at.x, 0.0, -at.y));
        cloth.run(0.4);
        cloth.mean(|_| true)
    };
    bound(
        format!(
            "mesh swings by an edge, {triangulation:?}, mean after 0.4 s against the grid's, m"
        ),
        SWING,
        mean(Some(triangulation)).distance(mean(None)),
    )
}

/// How fast a cloth is that has hung by two corners for ten seconds, and where, beside the grid.
fn two_corners(triangulation: Triangulation) -> [Case; 2] {
    let hang = |triangulation| {
        let corners = |at: Vec3| at.y == 0.0 && (at.x == 0.0 || at.x == 1.0);
        let ripple = |at: Vec3| at + Vec3::Z * 1e-3 * (5.0 * at.x + 3.0 * at.y).sin();
        let mut cloth = Cloth::new(square(triangulation, 33, 0.0, corners), STANDARD, ripple);
        cloth.run(10.0);
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

/// Mean strain of a flag in a wind of 6 m/s, beside the grid's.
fn flag(triangulation: Triangulation) -> Case {
    let strain = |triangulation| {
        let fabric = square(triangulation, 33, 0.0, |at| at.x == 0.0);
        let material = FabricMaterial { damping: 0.2, ..STANDARD };
        let mut cloth = Cloth::new(fabric, material, |at| at + Vec3::Z * 1e-4 * at.y);
        cloth.drive(Drive { wind: Vec3::new(6.0, 0.0, 0.9), ..Drive::default() });
        cloth.run(2.0);
        let strains = (0..360).map(|_| {
            cloth.tick();
            cloth.strain()
        });
        mean(&strains.collect::<Vec<f64>>())
    };
    bound(
        format!("mesh in wind of 6 m/s, {triangulation:?}, mean strain against the grid's"),
        FLAG * strain(None),
        strain(Some(triangulation)),
    )
}
