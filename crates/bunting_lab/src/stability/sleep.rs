//! Cloth that comes to rest in an app falls asleep, and stays where it is.

use bevy_app::App;
use bevy_bunting::{
    AttachedVertices, Attachment, ClothActivity, ClothCorner, ClothMaterial, ClothMesh, ClothState,
};
use bevy_ecs::entity::Entity;
use bunting_solver::StepSettings;
use glam::DVec3;

use super::case::HardCase;
use crate::{
    game, product,
    scenes::{Scene, ticks},
    simulation::in_double,
    stats::rms_distance,
};

/// Vertices along each side of the sheet.
const SIZE: usize = 17;
/// Longest time that a sheet damped by 2/s takes to fall asleep, s.
const SLEEPY: f64 = 10.0;
/// Time that the sheet hangs after that, s.
const TEN_MINUTES: f64 = 600.0;
/// Largest drift, m; the sheet measures one metre.
const DRIFT: f64 = 1e-4;

/// Cases of a sheet hung by two corners: the time until it sleeps, and its drift afterwards.
pub fn cases(_quick: bool) -> Vec<HardCase> {
    let scene = Scene::hang_corners(SIZE);
    let mut app = game::app_in_still_air([StepSettings::default()]);
    let corners = vec![ClothCorner::TopLeft, ClothCorner::TopRight];
    let size = SIZE as u32;
    let sheet = (
        ClothMesh::grid(size, size, scene.width as f32, scene.height as f32),
        ClothMaterial(product::material(&scene)),
        Attachment::in_place(AttachedVertices::Corners(corners)),
    );
    let sheet = app.world_mut().spawn(sheet).id();
    let asleep = (1..=ticks(2.0 * SLEEPY)).find(|_| {
        app.update();
        state(&app, sheet).activity() == ClothActivity::AtRest
    });
    let seconds = asleep.map_or(f64::INFINITY, |tick| tick as f64 / ticks(1.0) as f64);
    let before = positions(&app, sheet);
    (0..ticks(TEN_MINUTES)).for_each(|_| app.update());
    let drift = rms_distance(&before, &positions(&app, sheet));
    vec![
        HardCase::new("rest: sleeps", SIZE, "s until asleep", seconds, SLEEPY),
        HardCase::new("rest: 10 min in an app", SIZE, "drift, m", drift, DRIFT),
    ]
}

fn state(app: &App, sheet: Entity) -> &ClothState {
    app.world().get(sheet).expect("a cloth has a state")
}

fn positions(app: &App, sheet: Entity) -> Vec<DVec3> {
    in_double(state(app, sheet).positions())
}
