//! Tests that cloth which moves while no viewer sees it wakes where it is seen again.

use bevy_app::prelude::*;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::{Quat, Vec3};
use bevy_transform::prelude::*;
use bunting_tests::{FLAG, TICK, app, run, state};

/// Distance of the viewer from the figure when it looks at it, m.
const BEFORE: Vec3 = Vec3::new(0.0, 0.0, 6.0);

/// Ticks within which a cloth that is seen again wakes: cloths off the screen are examined in turns.
const AWAKE_WITHIN: usize = 8;

/// A figure with a flag, whose levels are automatic, and a viewer.
struct Scene {
    app: App,
    figure: Entity,
    flag: Entity,
    viewer: Entity,
}

impl Scene {
    fn new() -> Self {
        let mut app = app();
        let world = app.world_mut();
        let figure = world.spawn(Transform::default()).id();
        let held = Attachment::new(figure, ClothEdge::Left);
        let flag = world.spawn((FLAG, LodSet::automatic(2), held)).id();
        let viewer = world.spawn((LodViewer::default(), Transform::from_translation(BEFORE))).id();
        world.spawn(WindField::steady(Vec3::new(6.0, 0.0, 2.0)));
        run(&mut app, 60);
        let mut scene = Self { app, figure, flag, viewer };
        assert_eq!(scene.activity(), ClothActivity::Ticking);
        let away = Quat::from_rotation_y(core::f32::consts::PI);
        scene.place(viewer, Transform::from_translation(BEFORE).with_rotation(away));
        run(&mut scene.app, 60);
        assert_eq!(scene.activity(), ClothActivity::OffScreen);
        scene
    }

    fn activity(&self) -> ClothActivity {
        state(&self.app, self.flag).activity()
    }

    fn place(&mut self, entity: Entity, at: Transform) {
        self.app.world_mut().entity_mut(entity).insert(at);
    }

    /// Moves the figure along a way (m) in a number of ticks, and what is on the screen `with` it.
    fn walk(&mut self, from: Vec3, way: Vec3, ticks: usize, with: Option<Entity>) -> usize {
        for tick in 1..=ticks {
            let at = from + way * (tick as f32 / ticks as f32);
            self.place(self.figure, Transform::from_translation(at));
            if let Some(viewer) = with {
                self.place(viewer, Transform::from_translation(at + BEFORE));
            }
            run(&mut self.app, 1);
            if self.activity() == ClothActivity::Ticking {
                return tick;
            }
        }
        ticks
    }
}

#[test]
fn a_cloth_that_walked_unseen_wakes_where_it_is_seen() {
    // A walk, a run, and a teleport.
    for (way, seconds) in [(1.0, 5.0), (15.0, 5.0), (40.0, 4.0), (15.0, TICK)] {
        let mut scene = Scene::new();
        let way = Vec3::new(0.0, 0.0, -way);
        let ticks = (seconds / TICK) as usize;
        scene.walk(Vec3::ZERO, way, ticks, None);
        assert_eq!(scene.activity(), ClothActivity::OffScreen);
        run(&mut scene.app, 10);
        scene.place(scene.viewer, Transform::from_translation(way + BEFORE));
        run(&mut scene.app, AWAKE_WITHIN);
        assert_eq!(scene.activity(), ClothActivity::Ticking, "after {way} in {ticks} ticks");
    }
}

#[test]
fn a_cloth_that_goes_on_walking_wakes_when_it_is_seen() {
    let mut scene = Scene::new();
    let way = Vec3::new(0.0, 0.0, -15.0);
    scene.walk(Vec3::ZERO, way, 320, None);
    let viewer = scene.viewer;
    let ticks = scene.walk(way, way, 320, Some(viewer));
    assert!(ticks <= AWAKE_WITHIN, "{ticks}");
}

#[test]
fn a_cloth_that_has_left_its_place_stays_asleep_when_that_is_seen() {
    let mut scene = Scene::new();
    scene.walk(Vec3::ZERO, Vec3::new(40.0, 0.0, 0.0), 320, None);
    scene.place(scene.viewer, Transform::from_translation(BEFORE));
    run(&mut scene.app, 60);
    assert_eq!(scene.activity(), ClothActivity::OffScreen);
}
