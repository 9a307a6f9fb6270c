//! Tests that the trials catch the errors that they are designed for.

use bunting_lab::{
    oracles::{Case, trials},
    product::Product,
    reference::{
        grid::Grid,
        verlet::{Verlet, resolving_steps},
    },
    scenes::{Scene, TICK_RATE},
    simulation::Simulation,
    specimen::{Mount, Specimen},
};
use bunting_solver::StepSettings;
use glam::{DVec3, Vec3};

/// Starts the product on a modified scene, unknown to the trial.
fn sabotaged(change: impl Fn(&mut Scene)) -> impl Fn(&Scene, StepSettings) -> Box<dyn Specimen> {
    move |scene, settings| {
        let mut changed = scene.clone();
        change(&mut changed);
        Box::new(Product::lone(settings).start(&changed))
    }
}

fn passed(cases: &[Case], name: &str) -> usize {
    cases.iter().filter(|case| case.name.starts_with(name) && case.pass).count()
}

#[track_caller]
fn assert_caught(trial: &str, cases_named: &str, broken: &Mount) {
    let sound = trials::named(trial, &sabotaged(|_| ()));
    let caught = trials::named(trial, broken);
    assert!(passed(&sound, cases_named) > 0, "{trial} passes no {cases_named} of a sound solver");
    assert_eq!(passed(&caught, cases_named), 0, "{caught:#?}");
}

#[test]
fn a_sound_solver_falls_freely() {
    let cases = trials::named("free fall", &sabotaged(|_| ()));
    assert!(cases.iter().all(|case| case.pass), "{cases:#?}");
}

#[test]
fn a_wrong_mass_stretches_wrongly() {
    let heavy = sabotaged(|scene| scene.fabric.density *= 2.0);
    assert_caught("static stretch", "stretch, Y", &heavy);
}

#[test]
fn a_skipped_constraint_hangs_too_deep() {
    let torn = sabotaged(|scene| scene.fabric.stretch[1] = 1.0);
    assert_caught("catenary", "catenary, S", &torn);
}

#[test]
fn missing_bending_droops() {
    let limp = sabotaged(|scene| scene.fabric.bending *= 1e-2);
    assert_caught("cantilever", "cantilever, Γ", &limp);
}

#[test]
fn weak_bending_buckles_early() {
    let weak = sabotaged(|scene| scene.fabric.bending *= 0.97);
    assert_caught("buckling", "Greenhill column σ", &weak);
}

#[test]
fn the_reference_has_the_twist_that_holds_a_strip_on_edge() {
    let mount: &Mount = &|scene, _| Box::new(Exact::new(scene.clone()));
    assert!(!trials::strip_on_edge_buckles(mount, 4, 0.9));
    assert!(trials::strip_on_edge_buckles(mount, 4, 1.3));
}

/// The reference as a specimen.
struct Exact {
    scene: Scene,
    cloth: Verlet,
    seen: [Vec<Vec3>; 2],
}

impl Exact {
    fn new(scene: Scene) -> Self {
        let cloth = Verlet::new(&scene, resolving_steps(&Grid::new(&scene)));
        Self { scene, cloth, seen: Default::default() }
    }

    fn look(&mut self) {
        let single = |vectors: &[DVec3]| vectors.iter().map(|v| v.as_vec3()).collect();
        self.seen = [single(&self.cloth.positions), single(&self.cloth.velocities)];
    }
}

impl Simulation for Exact {
    fn tick(&mut self) {
        self.cloth.tick();
        self.look();
    }

    fn positions(&self) -> &[Vec3] {
        &self.seen[0]
    }

    fn velocities(&self) -> &[Vec3] {
        &self.seen[1]
    }
}

impl Specimen for Exact {
    fn place(&mut self, positions: &[DVec3], velocities: &[DVec3]) {
        self.cloth.positions = positions.to_vec();
        self.cloth.velocities = velocities.to_vec();
        self.look();
    }

    fn load(&mut self, gravity: f64) {
        let Verlet { positions, velocities, .. } = self.cloth.clone();
        *self = Self::new(Scene { gravity, ..self.scene.clone() });
        self.place(&positions, &velocities);
    }
}

#[test]
fn explicit_drag_reverses_the_motion() {
    let explicit: &Mount = &|scene, settings| Box::new(ExplicitDrag::new(scene, settings.substeps));
    assert_caught("drag", "drag alone from 20 m/s, ticks not turned round", explicit);
}

/// Independent particles, broadside under explicit drag ½ρC_d|v|v/σ.
struct ExplicitDrag {
    positions: Vec<Vec3>,
    velocities: Vec<Vec3>,
    gravity: f32,
    /// ρC_d/2σ, 1/m.
    drag: f32,
    substeps: u32,
}

impl ExplicitDrag {
    fn new(scene: &Scene, substeps: u32) -> Self {
        let positions: Vec<Vec3> = scene.positions().iter().map(|x| x.as_vec3()).collect();
        Self {
            velocities: vec![Vec3::ZERO; positions.len()],
            positions,
            gravity: scene.gravity as f32,
            drag: (scene.air.pressure / (2.0 * scene.fabric.density)) as f32,
            substeps,
        }
    }
}

impl Simulation for ExplicitDrag {
    fn tick(&mut self) {
        let step = 1.0 / (TICK_RATE * self.substeps) as f32;
        for _ in 0..self.substeps {
            for (x, v) in self.positions.iter_mut().zip(&mut self.velocities) {
                v.y -= step * (self.gravity + self.drag * v.y.abs() * v.y);
                *x += *v * step;
            }
        }
    }

    fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    fn velocities(&self) -> &[Vec3] {
        &self.velocities
    }
}

impl Specimen for ExplicitDrag {
    fn place(&mut self, positions: &[DVec3], velocities: &[DVec3]) {
        self.positions = positions.iter().map(|x| x.as_vec3()).collect();
        self.velocities = velocities.iter().map(|v| v.as_vec3()).collect();
    }

    fn load(&mut self, gravity: f64) {
        self.gravity = gravity as f32;
    }
}
