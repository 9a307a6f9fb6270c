//! Meshes that are no grids, by default settings: closed forms where there are some; elsewhere bounds, and the grid of
//! as many particles, as this group asks whether a mesh is as good as a grid.

mod curved;
mod flags;
mod graded;
mod rest;
mod swing;

use std::sync::Arc;

use bunting_solver::{
    ClothBatch, ClothSnapshot, Drive, Fabric, FabricBuilder, FabricMaterial, Grid, LaneCount,
    StepLimits, StepSettings,
};
use glam::{DVec2, DVec3, Vec3};

use crate::{
    meshes::{Sheet, Triangulation},
    oracles::Case,
    product::TICK,
    scenes::{GRAVITY, TICK_RATE},
    specimen::Mount,
    stats::mean,
};

const TRIANGULATIONS: [Triangulation; 3] =
    [Triangulation::Delaunay, Triangulation::Quads, Triangulation::Scan];
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
/// Greatest distance of a border's particles from the border, m.
const ROUNDING: f32 = 1e-5;
/// Speed at rest, m/s RMS, and distance from the grid, m, that pass.
const REST: [f64; 2] = [1e-3, 5e-3];

/// Everything that a mesh should do as a grid does.
pub fn cases(_: &Mount) -> Vec<Case> {
    let of_each = TRIANGULATIONS.into_iter().flat_map(rest::cases);
    let arcs = TRIANGULATIONS.into_iter().flat_map(curved::cases);
    of_each
        .chain(arcs)
        .chain(graded::cases())
        .chain(swing::cases())
        .chain([6.0, 25.0].into_iter().flat_map(flags::cases))
        .collect()
}

/// A square metre of about `n` × `n` particles, or the grid of as many.
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

/// Whether a particle of a sheet rests at the lower end of a metre's height.
fn at_bottom(at: Vec3) -> bool {
    at.y < -1.0 + ROUNDING
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
        self.tick_by(StepLimits::default().of_fabric(&self.fabric, TICK, GRAVITY as f32));
    }

    fn tick_by(&mut self, settings: StepSettings) {
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
}

/// A measured size that must not exceed a limit.
fn bound(name: String, limit: f64, measured: f64) -> Case {
    let relative_error = measured / limit;
    let pass = relative_error <= 1.0;
    Case { name, expected: limit, measured, relative_error, tolerance: 1.0, pass }
}
