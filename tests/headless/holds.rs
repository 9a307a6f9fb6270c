//! Tests of anchors with springs, rails and breaking forces, and of cloth that is grabbed.

use bevy_app::App;
use bevy_bunting::WakeCloth;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_transform::prelude::*;
use bunting_tests::{Seen, TICK, app, assert_finite, greatest_speed, run, state};

/// A sheet of a metre.
const SHEET: ClothMesh = ClothMesh::grid(17, 17, 1.0, 1.0);

/// Material that comes to rest.
const DAMPED: FabricMaterial = FabricMaterial { damping: 2.0, ..FabricMaterial::FLAG_POLYESTER };

/// Weight of the sheet, N.
const WEIGHT: f32 = 9.81 * DAMPED.area_density;

fn pole(app: &mut App, at: Vec3) -> Entity {
    app.world_mut().spawn(Transform::from_translation(at)).id()
}

/// Spawns the sheet on a pole, with no other vertices held than those of its anchors.
fn sheet(app: &mut App, pole: Entity, anchors: impl IntoIterator<Item = Anchor>) -> Entity {
    let mut attachment = Attachment::new(pole, AttachedVertices::List(Vec::new()));
    attachment.anchors.extend(anchors);
    app.world_mut().spawn((SHEET, ClothMaterial(DAMPED), attachment)).id()
}

/// Places of some particles in the world, m.
fn places(app: &App, cloth: Entity, particles: &[usize]) -> Vec<Vec3> {
    let frame = app.world().get::<GlobalTransform>(cloth).expect("a transform");
    let positions = state(app, cloth).positions();
    particles.iter().map(|&at| frame.transform_point(positions[at])).collect()
}

/// Mean height of the upper edge, m.
fn edge(app: &App, cloth: Entity) -> f32 {
    let positions = state(app, cloth).positions();
    let columns = if positions.len() == 17 * 17 { 17 } else { 9 };
    let edge: Vec<usize> = (0..columns).collect();
    places(app, cloth, &edge).iter().map(|at| at.y).sum::<f32>() / columns as f32
}

#[test]
fn springs_stretch_by_force_over_stiffness_at_every_level_and_after_sleep() {
    let mut app = app();
    let pole = pole(&mut app, Vec3::ZERO);
    let anchor = Anchor::new(pole, ClothEdge::Top).with_stiffness(20.0);
    let sheet = sheet(&mut app, pole, [anchor]);
    app.world_mut().entity_mut(sheet).insert(AnchorReactions::default());
    for level in [0, 1] {
        app.world_mut().entity_mut(sheet).insert(LodSet::new([10.0]).pinned_to(level));
        app.world_mut().trigger(WakeCloth { entity: sheet });
        run(&mut app, 1500);
        assert_eq!(state(&app, sheet).activity(), ClothActivity::AtRest);
        let stretch = -edge(&app, sheet);
        let error = stretch / (WEIGHT / 20.0) - 1.0;
        assert!(error.abs() < 0.01, "level {level}: {stretch} m");
        let reactions = app.world().get::<AnchorReactions>(sheet).expect("reactions");
        let force = reactions.anchors[0].force;
        assert!(force.distance(Vec3::NEG_Y * WEIGHT) < 0.01 * WEIGHT, "level {level}: {force}");
        // About the sheet's origin, which is its corner.
        let torque = reactions.anchors[0].torque;
        assert!((torque.z / (-0.5 * WEIGHT) - 1.0).abs() < 0.02, "level {level}: {torque}");
    }
    app.world_mut().get_mut::<Transform>(pole).expect("a pole").translation.y = 1.0;
    run(&mut app, 1500);
    let error = (1.0 - edge(&app, sheet)) / (WEIGHT / 20.0) - 1.0;
    assert!(error.abs() < 0.01, "after sleep: {}", edge(&app, sheet));
}

#[test]
fn an_anchor_breaks_and_lets_go_without_a_jump() {
    for stiffness in [None, Some(500.0)] {
        let mut app = app();
        app.insert_resource(Seen::<ClothAnchorBroke>(Vec::new())).add_observer(
            |event: On<ClothAnchorBroke>, mut seen: ResMut<Seen<ClothAnchorBroke>>| {
                seen.0.push(*event.event());
            },
        );
        let masts = [0.0, 1.0].map(|x| pole(&mut app, Vec3::X * x));
        let anchor = |mast: usize, corner: ClothCorner| {
            let offset = Transform::from_xyz(-(mast as f32), 0.0, 0.0);
            let anchor = Anchor::new(masts[mast], corner).with_offset(offset);
            match stiffness {
                Some(stiffness) => anchor.with_stiffness(stiffness),
                None => anchor,
            }
        };
        let holds = [
            anchor(0, ClothCorner::TopLeft).breaking_at(3.0 * WEIGHT),
            anchor(1, ClothCorner::TopRight).breaking_at(3.0 * WEIGHT),
        ];
        let sheet = sheet(&mut app, masts[0], holds);
        run(&mut app, 300);
        assert!(app.world().resource::<Seen<ClothAnchorBroke>>().0.is_empty());
        let mut fastest = 0.0_f32;
        for _ in 0..200 {
            // The right mast moves away at 0.5 m/s.
            if app.world().resource::<Seen<ClothAnchorBroke>>().0.is_empty() {
                let mut mast = app.world_mut().get_mut::<Transform>(masts[1]).expect("a mast");
                mast.translation.x += 0.5 * TICK;
            }
            let before = greatest_speed(&app, sheet);
            run(&mut app, 1);
            fastest = fastest.max(greatest_speed(&app, sheet) - before);
        }
        let broke = &app.world().resource::<Seen<ClothAnchorBroke>>().0;
        let [ClothAnchorBroke { entity, target, anchor, force }] = broke[..] else {
            panic!("{stiffness:?}: {broke:?}")
        };
        assert_eq!((entity, target), (sheet, masts[anchor]));
        assert!(force.length() > 3.0 * WEIGHT, "{force}");
        assert_eq!(app.world().get::<Attachment>(sheet).expect("attached").anchors.len(), 1);
        assert_finite(&app, sheet);
        // The taut edge snaps back, as it is stretched by the force: no faster than that.
        assert!(fastest < 4.0, "{stiffness:?}: {fastest} m/s in a tick");
        run(&mut app, 600);
        let corner = if anchor == 0 { 16 } else { 0 };
        let held = places(&app, sheet, &[corner])[0];
        let mast = app.world().get::<Transform>(masts[1 - anchor]).expect("a mast").translation;
        assert!(held.distance(mast) < 0.02, "{held} on {mast}");
    }
}

#[test]
fn rings_slide_down_a_rail_to_its_end() {
    let mut app = app();
    let pole = pole(&mut app, Vec3::new(0.0, 2.0, 1.0));
    let points = vec![Vec3::ZERO, Vec3::new(2.0, -0.2, 0.0), Vec3::new(4.0, -1.2, 0.0)];
    let hold = AnchorHold::Rail { points, ring_mass: 0.01, friction: 0.05 };
    let rings = AttachedVertices::List((0..17).step_by(4).collect());
    let curtain = sheet(&mut app, pole, [Anchor::new(pole, rings).with_hold(hold)]);
    app.world_mut().entity_mut(curtain).insert(LodSet { pinned: Some(0), ..LodSet::default() });
    let start = Vec3::new(0.0, 2.0, 1.0);
    for tick in 0..900 {
        run(&mut app, 1);
        if tick < 60 {
            continue;
        }
        for ring in places(&app, curtain, &[0, 4, 8, 12, 16]) {
            let at = ring - start;
            let height = if at.x < 2.0 { -0.1 * at.x } else { -0.2 - 0.5 * (at.x - 2.0) };
            assert!((at.y - height).abs() < 5e-3 && at.z.abs() < 5e-3, "{at} in tick {tick}");
        }
    }
    let last = places(&app, curtain, &[16])[0] - start;
    assert!(last.distance(Vec3::new(4.0, -1.2, 0.0)) < 0.01, "{last}");
}

/// A sheet that hangs by its upper edge, and a hand.
fn hanging(app: &mut App) -> (Entity, Entity) {
    let pole = pole(app, Vec3::ZERO);
    let attachment = Attachment::new(pole, ClothEdge::Top);
    let sheet = app.world_mut().spawn((SHEET, ClothMaterial(DAMPED), attachment)).id();
    run(app, 600);
    let corner = places(app, sheet, &[288])[0];
    (sheet, app.world_mut().spawn(Transform::from_translation(corner)).id())
}

#[test]
fn cloth_is_grabbed_and_let_go_without_a_jump() {
    let mut app = app();
    let (sheet, hand) = hanging(&mut app);
    assert_eq!(state(&app, sheet).activity(), ClothActivity::AtRest);
    app.world_mut().entity_mut(hand).insert(ClothGrab::within(sheet, 0.1));
    run(&mut app, 60);
    let grabbed = app.world().get::<bevy_bunting::Grabbed>(hand).expect("grabbed").count();
    assert!((3..6).contains(&grabbed), "{grabbed}");
    assert!(greatest_speed(&app, sheet) < 0.01, "{}", greatest_speed(&app, sheet));
    // The hand lifts the corner.
    let start = places(&app, sheet, &[288])[0];
    for _ in 0..64 {
        let mut place = app.world_mut().get_mut::<Transform>(hand).expect("a hand");
        place.translation += Vec3::new(0.1, 0.5, 0.3) * TICK;
        run(&mut app, 1);
    }
    run(&mut app, 128);
    let lifted = places(&app, sheet, &[288])[0] - start;
    assert!(lifted.distance(Vec3::new(0.1, 0.5, 0.3)) < 0.03, "{lifted}");
    let force = app.world().get::<bevy_bunting::Grabbed>(hand).expect("grabbed").force();
    assert!(force.y < -0.1 * WEIGHT && force.length() < WEIGHT, "{force}");
    for level in [1, 0, 1] {
        app.world_mut().entity_mut(sheet).insert(LodSet::new([10.0]).pinned_to(level));
        run(&mut app, 64);
        let corner = state(&app, sheet).positions().len() - 1;
        let held = places(&app, sheet, &[corner])[0] - start;
        assert!(held.distance(Vec3::new(0.1, 0.5, 0.3)) < 0.06, "level {level}: {held}");
    }
    let before = greatest_speed(&app, sheet);
    app.world_mut().despawn(hand);
    run(&mut app, 1);
    assert!(greatest_speed(&app, sheet) - before < 1.5 * 9.81 * TICK + 0.1);
    run(&mut app, 600);
    let corner = state(&app, sheet).positions().len() - 1;
    assert!(places(&app, sheet, &[corner])[0].distance(start) < 0.05);
}

#[test]
fn a_weak_hand_slips_no_further_than_its_force() {
    let mut app = app();
    let (sheet, hand) = hanging(&mut app);
    let grab = ClothGrab::within(sheet, 0.1).with_strength(500.0, 0.2 * WEIGHT);
    app.world_mut().entity_mut(hand).insert(grab);
    run(&mut app, 2);
    for _ in 0..64 {
        let mut place = app.world_mut().get_mut::<Transform>(hand).expect("a hand");
        place.translation.y += TICK;
        run(&mut app, 1);
        let force = app.world().get::<bevy_bunting::Grabbed>(hand).expect("grabbed").force();
        assert!(force.length() < 0.21 * WEIGHT, "{force}");
    }
}
