//! The solver under measurement, on the scenes.
//!
//! The scenes' vertices are ordered like the solver's grid, so positions pass through unchanged. The cloth's
//! frame is the world; the pose of the sheet is only in the positions of its particles.

use std::{fmt, sync::Arc};

use bunting_solver::{
    ClothBatch, ClothSnapshot, Collider, Drive, Fabric, FabricBuilder, FabricMaterial, Grid,
    LaneCount, LinkFamily, Scheme, StepLimits, StepSettings,
};
use glam::{DVec3, Vec3};

use crate::{
    contender::Contender,
    need::Need,
    scenes::{self, Scene, TICK_RATE},
    simulation::Simulation,
    specimen::Specimen,
};

/// Density of the air in the scenes, kg/m³: the scenes give only its product with a coefficient.
const AIR_DENSITY: f32 = 1.225;
/// Length of a tick, s.
pub const TICK: f32 = 1.0 / TICK_RATE as f32;

/// Default scheme, substeps and passes: `StepSettings::default()` as a constant.
pub const DEFAULT: StepSettings = StepSettings { passes: 2, ..StepSettings::yarns(2) };

/// The solver with its settings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Product {
    /// Scheme, substeps and passes.
    pub settings: StepSettings,
    /// Cloths side by side, all alike.
    pub lanes: LaneCount,
}

impl Product {
    /// One cloth.
    #[must_use]
    pub const fn lone(settings: StepSettings) -> Self {
        Self { settings, lanes: LaneCount::One }
    }

    /// The settings that the tables show, the cheapest first within each scheme.
    #[must_use]
    pub fn catalogue() -> Vec<Self> {
        let schemes = [
            (StepSettings::gauss_seidel as fn(u32) -> StepSettings, &[5, 10, 20][..]),
            (StepSettings::yarns, &[2, 3, 4, 5]),
        ];
        let mut products = Vec::new();
        for (scheme, substeps) in schemes {
            for &substeps in substeps {
                for passes in [1, 2] {
                    for &lanes in LaneCount::available() {
                        let settings = StepSettings { passes, ..scheme(substeps) };
                        products.push(Self { settings, lanes });
                    }
                }
            }
        }
        products
    }

    /// The scene at its start, with a cloth in every lane.
    ///
    /// # Panics
    ///
    /// When the scene is not a valid cloth.
    #[must_use]
    pub fn start(&self, scene: &Scene) -> Cloth {
        self.start_cut(fabric(scene), scene)
    }

    /// The scene at its start, with a given fabric of the scene's particles.
    ///
    /// # Panics
    ///
    /// When the fabric's particles are not the scene's.
    #[must_use]
    pub fn start_cut(&self, fabric: Arc<Fabric>, scene: &Scene) -> Cloth {
        Cloth::new(fabric, scene, self.settings, self.lanes)
    }
}

impl fmt::Display for Product {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self.settings.scheme {
            Scheme::GaussSeidel => "bunting Gauss–Seidel",
            Scheme::Yarns => "bunting yarns",
        })
    }
}

impl From<Product> for Contender {
    fn from(product: Product) -> Self {
        Self {
            method: product.to_string(),
            substeps: product.settings.substeps as usize,
            passes: product.settings.passes as usize,
            lanes: product.lanes.get(),
            start: Box::new(move |scene| Some(Box::new(product.start(scene)))),
        }
    }
}

/// Grid and pins of a scene.
///
/// # Panics
///
/// When the scene has fewer than two rows or columns.
#[must_use]
pub fn fabric(scene: &Scene) -> Arc<Fabric> {
    Arc::new(pattern(scene).build().expect("a scene is a good grid"))
}

/// Builder of that fabric.
#[must_use]
pub fn pattern(scene: &Scene) -> FabricBuilder {
    let grid =
        Grid::new(scene.columns as u32, scene.rows as u32, scene.width as f32, scene.height as f32);
    let pinned = (0..scene.vertices()).filter(|&vertex| scene.is_pinned(vertex));
    FabricBuilder::grid(grid).pin(pinned.map(|vertex| vertex as u32))
}

/// Material of a scene, from its fabric, its damping and its air.
#[must_use]
pub fn material(scene: &Scene) -> FabricMaterial {
    let scenes::Fabric { density, stretch: [warp, weft], shear, bending } = scene.fabric;
    FabricMaterial {
        area_density: density as f32,
        warp_stiffness: warp as f32,
        weft_stiffness: weft as f32,
        shear_stiffness: shear as f32,
        bend_stiffness: bending as f32,
        damping: scene.damping as f32,
        internal_damping: 0.0,
        pressure_coefficient: scene.air.pressure as f32 / AIR_DENSITY,
        friction_coefficient: scene.air.friction as f32 / AIR_DENSITY,
        thickness: 0.0,
        surface_friction: 0.0,
    }
}

/// RMS speed of a lane, m/s; infinite if it is not a number.
#[must_use]
pub fn rms_speed(batch: &ClothBatch, lane: usize) -> f64 {
    let mut velocities = Vec::new();
    batch.copy_velocities(lane, &mut velocities);
    let sum: f64 = velocities.iter().map(|v: &Vec3| f64::from(v.length_squared())).sum();
    let speed = (sum / velocities.len() as f64).sqrt();
    if speed.is_finite() { speed } else { f64::INFINITY }
}

/// Strain of each link along warp and weft of a cloth with these positions, m.
pub fn yarn_strains(fabric: &Fabric, positions: &[Vec3]) -> impl Iterator<Item = f64> {
    let yarns = fabric.links().iter().filter(|link| link.family != LinkFamily::Diagonal);
    yarns.map(|link| {
        let [from, to] = link.particles.map(|at| positions[at as usize]);
        f64::from(from.distance(to) / link.rest_length) - 1.0
    })
}

/// Cloths of one scene in all lanes of a batch; the first is the one that is measured.
#[derive(Clone, Debug)]
pub struct Cloth {
    /// The batch.
    pub batch: ClothBatch,
    /// Scheme, substeps and passes.
    pub settings: StepSettings,
    /// Frame motion, gravity and air of every lane; the wind is set in each tick.
    pub drive: Drive,
    /// Whether normals are computed at the end of a tick.
    pub normals: bool,
    /// Chooses the substeps of each tick for the cloth that is measured; none where the settings hold.
    pub need: Option<Need>,
    scene: Scene,
    seconds: f64,
    positions: Vec<Vec3>,
    velocities: Vec<Vec3>,
}

impl Cloth {
    fn new(fabric: Arc<Fabric>, scene: &Scene, settings: StepSettings, lanes: LaneCount) -> Self {
        let mut batch = ClothBatch::new(fabric, lanes);
        let positions: Vec<Vec3> = scene.positions().iter().map(|x| x.as_vec3()).collect();
        let velocities = vec![Vec3::ZERO; positions.len()];
        let start = ClothSnapshot::new(positions.clone(), velocities.clone());
        for _ in 0..lanes.get() {
            batch.insert(&start, material(scene)).expect("a scene is a good cloth");
        }
        let gravity = Vec3::new(0.0, -scene.gravity as f32, 0.0);
        let drive = Drive { gravity, air_density: AIR_DENSITY, ..Drive::NONE };
        let scene = scene.clone();
        Self {
            batch,
            settings,
            drive,
            normals: true,
            need: None,
            scene,
            seconds: 0.0,
            positions,
            velocities,
        }
    }

    /// Advances by some seconds, in one tick of that length.
    pub fn advance(&mut self, tick: f32) {
        let middle = self.seconds + 0.5 * f64::from(tick);
        let drive = Drive { wind: self.scene.air.wind_at(middle).as_vec3(), ..self.drive };
        for lane in 0..self.batch.lane_count() {
            self.batch.drive(lane, drive).expect("a good drive");
        }
        if let Some(need) = &mut self.need {
            self.settings = need.settings(self.batch.fabric(), &drive, tick);
        }
        self.batch.begin_tick(tick, self.settings);
        for _ in 0..self.settings.substeps {
            self.batch.integrate();
            self.batch.solve_constraints();
            self.batch.update_velocities();
        }
        if self.normals {
            self.batch.compute_normals();
        }
        self.seconds += f64::from(tick);
        let before = self.need.is_some().then(|| self.positions.clone());
        self.look();
        if let (Some(need), Some(before)) = (&mut self.need, &before) {
            let moved = [before, self.positions.as_slice()];
            need.note(&self.batch, &material(&self.scene), &drive, moved, tick);
        }
    }

    /// The cloth with substeps by need.
    #[must_use]
    pub fn by_need(self, limits: StepLimits) -> Self {
        Self { need: Some(Need::within(limits)), ..self }
    }

    /// Overwrites the state of every lane.
    ///
    /// # Panics
    ///
    /// When the state is of another fabric or not finite.
    pub fn restore(&mut self, state: &ClothSnapshot) {
        for lane in 0..self.batch.lane_count() {
            self.batch.restore(lane, state).expect("a good state");
        }
        self.look();
    }

    /// Changes the scene's air and fabric from the next tick on.
    ///
    /// # Panics
    ///
    /// When the new fabric is not a valid material.
    pub fn change(&mut self, change: impl FnOnce(&mut Scene)) {
        change(&mut self.scene);
        for lane in 0..self.batch.lane_count() {
            self.batch.set_material(lane, material(&self.scene)).expect("a good material");
        }
    }

    /// Sets the colliders of every lane.
    pub fn touch(&mut self, colliders: &[Collider]) {
        for lane in 0..self.batch.lane_count() {
            self.batch.set_colliders(lane, colliders.iter().cloned()).expect("good shapes");
        }
    }

    fn look(&mut self) {
        self.batch.copy_positions(0, &mut self.positions);
        self.batch.copy_velocities(0, &mut self.velocities);
    }
}

impl Simulation for Cloth {
    fn tick(&mut self) {
        self.advance(TICK);
    }

    fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    fn velocities(&self) -> &[Vec3] {
        &self.velocities
    }
}

impl Specimen for Cloth {
    fn place(&mut self, positions: &[DVec3], velocities: &[DVec3]) {
        let single = |vectors: &[DVec3]| vectors.iter().map(|v| v.as_vec3()).collect();
        self.restore(&ClothSnapshot::new(single(positions), single(velocities)));
    }

    fn load(&mut self, gravity: f64) {
        self.drive.gravity = Vec3::new(0.0, -gravity as f32, 0.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_measured_settings_are_the_defaults() {
        assert_eq!(DEFAULT, StepSettings::default());
    }
}
