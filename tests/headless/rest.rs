//! Tests that cloth at rest falls asleep, and wakes when something that acts on it changes.

use bevy_app::prelude::*;
use bevy_bunting::ClothBatches;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::{Mat4, Quat, Vec3};
use bevy_transform::prelude::*;
use bunting_tests::{app, bits, run, state};

/// Ticks in which a damped cloth comes to rest.
const SETTLING: usize = 64 * 20;

/// A sheet that hangs from a pole by its top edge, asleep, and a ball far away.
struct SleepingSheet {
    app: App,
    pole: Entity,
    sheet: Entity,
    ball: Entity,
}

fn sleeping_sheet() -> SleepingSheet {
    let mut app = app();
    let world = app.world_mut();
    let pole = world.spawn(Transform::from_xyz(0.0, 3.0, 0.0)).id();
    let material = FabricMaterial { damping: 2.0, ..FabricMaterial::COTTON };
    let held = Attachment::new(pole, ClothEdge::Top);
    let sheet = world.spawn((ClothMesh::grid(9, 9, 1.0, 1.0), ClothMaterial(material), held)).id();
    let ball = world.spawn((ClothCollider::ball(0.2), Transform::from_xyz(9.0, 3.0, 0.0))).id();
    run(&mut app, SETTLING);
    let scene = SleepingSheet { app, pole, sheet, ball };
    assert_eq!(scene.activity(), ClothActivity::AtRest);
    assert_eq!(scene.batches(), 0);
    scene
}

impl SleepingSheet {
    fn activity(&self) -> ClothActivity {
        state(&self.app, self.sheet).activity()
    }

    fn batches(&self) -> usize {
        self.app.world().resource::<ClothBatches>().batch_count()
    }

    fn entity(&mut self, entity: Entity) -> EntityWorldMut<'_> {
        self.app.world_mut().entity_mut(entity)
    }

    /// Runs five ticks.
    fn activity_after_ticks(&mut self) -> ClothActivity {
        run(&mut self.app, 5);
        self.activity()
    }
}

#[test]
fn a_sheet_at_rest_sleeps_until_something_changes() {
    let mut scene = sleeping_sheet();
    let shape = bits(&scene.app, scene.sheet);
    run(&mut scene.app, 100);
    assert_eq!(bits(&scene.app, scene.sheet), shape);
    assert_eq!(scene.batches(), 0);
}

#[test]
fn a_swinging_cloth_does_not_sleep() {
    let mut app = app();
    let material = FabricMaterial { damping: 0.0, ..FabricMaterial::COTTON };
    let held = Attachment::in_place(ClothEdge::Top);
    let turned = Transform::from_rotation(Quat::from_rotation_x(0.3));
    let sheet = (ClothMesh::grid(9, 9, 1.0, 1.0), ClothMaterial(material), held, turned);
    let sheet = app.world_mut().spawn(sheet).id();
    for _ in 0..300 {
        run(&mut app, 1);
        assert_eq!(state(&app, sheet).activity(), ClothActivity::Ticking);
    }
}

#[test]
fn wind_wakes_a_sheet() {
    let mut scene = sleeping_sheet();
    scene.app.world_mut().spawn(WindField::steady(Vec3::Z));
    assert_eq!(scene.activity_after_ticks(), ClothActivity::Ticking);
    assert_eq!(scene.batches(), 1);
}

#[test]
fn gravity_wakes_a_sheet() {
    let mut scene = sleeping_sheet();
    scene.app.world_mut().resource_mut::<ClothSettings>().gravity *= 0.5;
    assert_eq!(scene.activity_after_ticks(), ClothActivity::Ticking);
}

#[test]
fn a_moved_frame_wakes_a_sheet() {
    let mut scene = sleeping_sheet();
    let pole = scene.pole;
    scene.entity(pole).get_mut::<Transform>().expect("a place").translation.x += 0.1;
    assert_eq!(scene.activity_after_ticks(), ClothActivity::Ticking);
}

#[test]
fn a_teleport_wakes_a_sheet() {
    for mode in [TeleportMode::Keep, TeleportMode::Reset] {
        let mut scene = sleeping_sheet();
        let (pole, entity) = (scene.pole, scene.sheet);
        scene.app.world_mut().trigger(TeleportCloth { entity, mode });
        scene.entity(pole).insert(Transform::from_rotation(Quat::from_rotation_z(1.0)));
        assert_eq!(scene.activity_after_ticks(), ClothActivity::Ticking, "{mode:?}");
    }
}

/// Moves of an anchor's target or of a joint, m: motions, and a teleport, which leads from rest to rest.
const MOVES: [f32; 3] = [0.02, 0.1, 0.6];

#[test]
fn an_anchor_that_moves_or_is_teleported_wakes_a_sheet() {
    for way in MOVES {
        let mut scene = sleeping_sheet();
        let (pole, sheet) = (scene.pole, scene.sheet);
        let mast = scene.app.world_mut().spawn(Transform::from_xyz(0.0, 3.0, 0.0)).id();
        let held = Attachment::new(pole, ClothEdge::Top)
            .with_anchor(Anchor::new(mast, ClothCorner::BottomLeft));
        scene.entity(sheet).insert(held);
        run(&mut scene.app, SETTLING);
        assert_eq!(scene.activity(), ClothActivity::AtRest);
        scene.entity(mast).insert(Transform::from_xyz(way, 3.0, 0.0));
        assert_eq!(scene.activity_after_ticks(), ClothActivity::Ticking, "{way} m");
    }
}

#[test]
fn a_joint_that_moves_or_snaps_wakes_a_sheet() {
    for way in MOVES {
        let mut scene = sleeping_sheet();
        let (pole, sheet) = (scene.pole, scene.sheet);
        let joint = scene.app.world_mut().spawn((Transform::default(), ChildOf(pole))).id();
        let rigid = ([0; 4], [1.0, 0.0, 0.0, 0.0]);
        let skin = ClothSkin::new([(joint, Mat4::IDENTITY)])
            .with_vertices(core::iter::repeat_n(rigid, 9 * 9));
        scene.entity(sheet).insert(skin);
        run(&mut scene.app, SETTLING);
        assert_eq!(scene.activity(), ClothActivity::AtRest);
        scene.entity(joint).insert(Transform::from_xyz(way, 0.0, 0.0));
        assert_eq!(scene.activity_after_ticks(), ClothActivity::Ticking, "{way} m");
    }
}

#[test]
fn a_changed_material_wakes_a_sheet() {
    let mut scene = sleeping_sheet();
    let sheet = scene.sheet;
    scene.entity(sheet).insert(ClothMaterial::SILK);
    assert_eq!(scene.activity_after_ticks(), ClothActivity::Ticking);
}

#[test]
fn a_changed_attachment_wakes_a_sheet() {
    let mut scene = sleeping_sheet();
    let sheet = scene.sheet;
    scene.entity(sheet).remove::<Attachment>();
    assert_eq!(scene.activity_after_ticks(), ClothActivity::Ticking);
}

#[test]
fn only_a_near_collider_wakes_a_sheet() {
    let mut scene = sleeping_sheet();
    let ball = scene.ball;
    scene.entity(ball).insert(Transform::from_xyz(8.0, 3.0, 0.0));
    assert_eq!(scene.activity_after_ticks(), ClothActivity::AtRest);
    scene.entity(ball).insert(Transform::from_xyz(0.5, 2.5, 0.3));
    assert_eq!(scene.activity_after_ticks(), ClothActivity::Ticking);
}

#[test]
fn a_despawned_collider_wakes_a_sheet() {
    let mut scene = sleeping_sheet();
    let ball = scene.ball;
    scene.entity(ball).despawn();
    assert_eq!(scene.activity_after_ticks(), ClothActivity::Ticking);
}

#[test]
fn a_pause_keeps_a_sheet_asleep() {
    let mut scene = sleeping_sheet();
    let sheet = scene.sheet;
    scene.entity(sheet).insert(ClothPaused);
    scene.activity_after_ticks();
    scene.entity(sheet).remove::<ClothPaused>();
    assert_eq!(scene.activity_after_ticks(), ClothActivity::AtRest);
    scene.app.world_mut().spawn(WindField::steady(Vec3::Z));
    assert_eq!(scene.activity_after_ticks(), ClothActivity::Ticking);
}

#[test]
fn local_winds_wake_the_sheets_that_they_reach() {
    let gusty = WindField::steady(Vec3::Z).with_gusts(1.0, 0.5, 1);
    for (x, expected) in [(20.0, ClothActivity::AtRest), (2.0, ClothActivity::Ticking)] {
        let mut scene = sleeping_sheet();
        let place = Transform::from_xyz(x, 3.0, 0.0);
        scene.app.world_mut().spawn((gusty, WindRegion::ball(4.0, 1.0), place));
        assert_eq!(scene.activity_after_ticks(), expected, "{x} m away");
    }
}

#[test]
fn a_change_of_shelter_wakes_a_sheet() {
    let mut scene = sleeping_sheet();
    let sheet = scene.sheet;
    scene.entity(sheet).insert(WindInfluence(0.5));
    assert_eq!(scene.activity_after_ticks(), ClothActivity::Ticking);
    run(&mut scene.app, SETTLING);
    assert_eq!(scene.activity(), ClothActivity::AtRest);
    scene.entity(sheet).remove::<WindInfluence>();
    assert_eq!(scene.activity_after_ticks(), ClothActivity::Ticking);
}

#[test]
fn an_impulse_wakes_a_sheet() {
    let mut scene = sleeping_sheet();
    let far = ClothImpulse::velocity(Vec3::new(50.0, 3.0, 0.0), 2.0, Vec3::Z);
    scene.app.world_mut().trigger(far);
    assert_eq!(scene.activity_after_ticks(), ClothActivity::AtRest);
    let shape = bits(&scene.app, scene.sheet);
    let near = ClothImpulse::velocity(Vec3::new(0.0, 2.0, 0.0), 2.0, Vec3::Z);
    scene.app.world_mut().trigger(near);
    assert_eq!(scene.activity_after_ticks(), ClothActivity::Ticking);
    assert_ne!(bits(&scene.app, scene.sheet), shape);
}

#[test]
fn an_acceleration_wakes_a_sheet() {
    let mut scene = sleeping_sheet();
    let sheet = scene.sheet;
    scene.entity(sheet).insert(ClothAcceleration(Vec3::Z));
    assert_eq!(scene.activity_after_ticks(), ClothActivity::Ticking);
    run(&mut scene.app, SETTLING);
    assert_eq!(scene.activity(), ClothActivity::AtRest);
    scene.entity(sheet).remove::<ClothAcceleration>();
    assert_eq!(scene.activity_after_ticks(), ClothActivity::Ticking);
}

#[test]
fn control_wakes_a_sheet() {
    use bevy_ecs::system::RunSystemOnce;
    let mut scene = sleeping_sheet();
    let sheet = scene.sheet;
    let kick = move |mut control: ClothControl| {
        control.edit(sheet, |cloth| cloth.set_velocity(80, Vec3::Z)).expect("a good velocity");
    };
    scene.app.world_mut().run_system_once(kick).expect("the system runs");
    assert_eq!(scene.activity_after_ticks(), ClothActivity::Ticking);
}
