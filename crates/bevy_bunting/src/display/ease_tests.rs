//! Tests of the displayed surface across changes of level.

use std::time::Duration;

use bevy_app::App;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_time::{TimePlugin, TimeUpdateStrategy};

use crate::cloth::instance::ClothInstance;
use crate::cloth::mesh::ClothMesh;
use crate::cloth::state::ClothState;
use crate::display::easing::DURATION;
use crate::display::surface::ClothSurface;
use crate::fabric::levels::ClothLevels;
use crate::lod::lod_set::LodSet;
use crate::motion::attached_vertices::ClothEdge;
use crate::motion::attachment::Attachment;
use crate::{ClothPlugins, WindField};

const TICK: f32 = 1.0 / 64.0;

/// Size of a pixel at 10 m, for 1080 lines over 60°, m.
const PIXEL: f32 = 0.0107;

fn app() -> App {
    let mut app = App::new();
    app.add_plugins((TimePlugin, ClothPlugins::default()))
        .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_micros(15_625)));
    app.world_mut().spawn(WindField::steady(Vec3::new(6.0, 0.0, 2.0)));
    app
}

fn flag(app: &mut App, level: usize) -> Entity {
    let levels = LodSet::new([10.0, 20.0]).pinned_to(level);
    let attachment = Attachment::in_place(ClothEdge::Left);
    let mesh = ClothMesh::grid(17, 17, 1.0, 1.0);
    app.world_mut().spawn((mesh, levels, attachment, ClothSurface::default())).id()
}

fn pin(app: &mut App, flag: Entity, level: usize) {
    app.world_mut().get_mut::<LodSet>(flag).expect("levels").pinned = Some(level);
}

fn levels(app: &App, flag: Entity) -> &ClothLevels {
    let instance = app.world().get::<ClothInstance>(flag).expect("a cloth");
    instance.levels.as_ref().expect("levels")
}

/// The surface with the vertices of the finest level.
fn seen(app: &App, flag: Entity) -> Vec<Vec3> {
    let surface = app.world().get::<ClothSurface>(flag).expect("a surface");
    levels(app, flag).interpolate(surface.positions.clone(), surface.level(), 0)
}

/// Greatest distance of a vertex from its linear extrapolation from the two frames before, m.
fn strayed(frames: [&[Vec3]; 3]) -> f32 {
    let [before, now, after] = frames;
    let strays = (0..now.len()).map(|at| (now[at] + (now[at] - before[at])).distance(after[at]));
    strays.fold(0.0, f32::max)
}

#[test]
fn a_change_of_level_does_not_pop() {
    for (from, to) in [(0, 1), (1, 0), (0, 2), (2, 0), (1, 2)] {
        let mut app = app();
        let flag = flag(&mut app, from);
        (0..100).for_each(|_| app.update());
        // Frames are as long as ticks, so the displayed surface is that of the tick before.
        let mut frames = Vec::new();
        for frame in 0..30 {
            if frame == 26 {
                pin(&mut app, flag, to);
            }
            app.update();
            frames.push(seen(&app, flag));
        }
        assert_eq!(app.world().get::<ClothState>(flag).expect("a state").level(), to);
        let strays: Vec<f32> =
            frames.windows(3).map(|frames| strayed([&frames[0], &frames[1], &frames[2]])).collect();
        let (flight, change) = strays.split_at(25);
        assert!(change[0] < PIXEL, "{from} to {to}: {}", change[0]);
        // Later frames depart no more than the flag's own flapping does.
        let own = flight.iter().copied().fold(0.0, f32::max);
        assert!(change[1..].iter().all(|&stray| stray < 2.0 * own), "{change:?} {own}");
    }
}

#[test]
fn the_new_level_is_shown_in_time_and_without_a_jump() {
    for (from, to) in [(0, 1), (1, 0)] {
        let mut app = app();
        let flag = flag(&mut app, from);
        (0..120).for_each(|_| app.update());
        pin(&mut app, flag, to);
        app.update();
        let eased = |app: &App| app.world().get::<ClothSurface>(flag).expect("one").level();
        assert_eq!(eased(&app), 0, "the finer level's vertices");
        for frame in 0..(DURATION / TICK) as usize + 2 {
            let state = app.world().get::<ClothState>(flag).expect("a state");
            let bare = levels(&app, flag).interpolate(state.previous_positions().to_vec(), to, 0);
            let shown = seen(&app, flag);
            let apart = shown.iter().zip(&bare).map(|(shown, bare)| shown.distance(*bare));
            let apart = apart.fold(0.0, f32::max);
            if frame == 0 {
                assert!(apart > 0.01, "{from} to {to} begins with {apart}");
            } else if frame + 3 > (DURATION / TICK) as usize {
                assert!(apart < PIXEL, "{from} to {to} ends with {apart}");
            }
            app.update();
        }
        assert_eq!(eased(&app), to);
    }
}

#[test]
fn a_surface_whose_level_changes_in_every_tick_stays_near_the_cloth() {
    let mut app = app();
    let flag = flag(&mut app, 0);
    for frame in 0..300 {
        pin(&mut app, flag, frame % 3);
        app.update();
        if frame > 2 {
            let state = app.world().get::<ClothState>(flag).expect("a state").clone();
            let surface = seen(&app, flag);
            let corner = surface.len() - 1;
            let apart = surface[corner].distance(*state.positions().last().expect("a corner"));
            assert!(apart < 0.4, "frame {frame}: {apart}");
        }
    }
}
