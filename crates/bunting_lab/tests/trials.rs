//! The trials catch what they are meant to catch.

use bunting_lab::{
    baselines::sheet::Sheet,
    oracles::{
        Case,
        specimen::{Mount, Specimen},
        trials,
    },
    product::Product,
    scenes::{Scene, TICK_RATE},
    simulation::Simulation,
};
use bunting_solver::StepSettings;
use glam::{DVec3, Vec3};

/// The product on a scene that was changed behind the trial's back.
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
fn explicit_drag_brakes_too_hard() {
    let explicit: &Mount = &|scene, settings| Box::new(ExplicitDrag::new(scene, settings.substeps));
    let caught = trials::named("drag", explicit);
    assert_eq!(passed(&caught, "drag alone"), 0, "{caught:#?}");
}

/// Unconstrained particles under explicit drag.
struct ExplicitDrag {
    sheet: Sheet,
    previous: Vec<Vec3>,
    substeps: u32,
}

impl ExplicitDrag {
    fn new(scene: &Scene, substeps: u32) -> Self {
        let sheet = Sheet::new(scene);
        Self { previous: sheet.positions.clone(), sheet, substeps }
    }
}

impl Simulation for ExplicitDrag {
    fn tick(&mut self) {
        let step = 1.0 / (TICK_RATE * self.substeps) as f32;
        for _ in 0..self.substeps {
            self.sheet.predict(&mut self.previous, step);
        }
    }

    fn positions(&self) -> &[Vec3] {
        &self.sheet.positions
    }

    fn velocities(&self) -> &[Vec3] {
        &self.sheet.velocities
    }
}

impl Specimen for ExplicitDrag {
    fn place(&mut self, positions: &[DVec3], velocities: &[DVec3]) {
        self.sheet.positions = positions.iter().map(|x| x.as_vec3()).collect();
        self.sheet.velocities = velocities.iter().map(|v| v.as_vec3()).collect();
    }

    fn load(&mut self, gravity: f64) {
        self.sheet.gravity = Vec3::NEG_Y * gravity as f32;
    }
}
