//! Tests that nothing goes wrong without a message that names the entity and the remedy.

use core::time::Duration;

use bevy_app::prelude::*;
use bevy_bunting::ScaleInShape;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::{Vec2, Vec3};
use bevy_time::{TimePlugin, TimeUpdateStrategy};
use bevy_transform::prelude::*;
use bunting_tests::{FLAG, Seen, app, assert_finite, logged, run, state};

fn failures(app: &App) -> Vec<ClothFailed> {
    app.world().resource::<Seen<ClothFailed>>().0.clone()
}

/// Texts of the failures of one entity after some ticks with what it has.
fn messages(components: impl Bundle) -> Vec<String> {
    let mut app = app();
    let entity = app.world_mut().spawn(components).id();
    run(&mut app, 10);
    let failures = failures(&app);
    for failed in &failures {
        assert_eq!(failed.entity, entity);
        assert!(failed.error.to_string().contains(&entity.to_string()), "{failed:?}");
    }
    failures.iter().map(|failed| failed.error.to_string()).collect()
}

/// Asserts that components are reported once, with these words.
fn assert_said(components: impl Bundle, words: &[&str]) {
    let messages = messages(components);
    let [message] = &messages[..] else { panic!("{messages:?}, and not one with {words:?}") };
    assert!(words.iter().all(|word| message.contains(word)), "{message}");
}

#[test]
fn cloth_without_a_clock_stands_still_and_says_so() {
    logged();
    let mut app = App::new();
    app.add_plugins((TransformPlugin, ClothPlugins::default()));
    app.world_mut().spawn(FLAG);
    run(&mut app, 5);
    let of_clock = logged().into_iter().filter(|it| it.contains("TimePlugin"));
    assert_eq!(of_clock.count(), 1);
}

#[test]
fn cloth_in_an_app_without_its_plugins_says_so_once() {
    logged();
    let mut app = App::new();
    app.add_plugins((TimePlugin, TransformPlugin))
        .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_millis(16)));
    let flags = [(); 2].map(|()| app.world_mut().spawn(FLAG).id());
    run(&mut app, 3);
    let of_plugins: Vec<_> =
        logged().into_iter().filter(|it| it.contains("ClothPlugins::default()")).collect();
    assert_eq!(of_plugins.len(), 1);
    assert!(of_plugins[0].contains(&flags[0].to_string()), "{of_plugins:?}");
    // A world of a scene or of a server's own loop is no app.
    World::new().spawn(FLAG);
    assert_eq!(logged().iter().filter(|it| it.contains("ClothPlugins::default()")).count(), 1);
}

#[test]
#[should_panic(expected = "in group bevy_bunting::ClothPlugins: plugin was already added")]
fn plugins_that_are_added_twice_are_named() {
    App::new().add_plugins(ClothPlugins::default()).add_plugins(ClothPlugins::default());
}

#[test]
fn winds_that_cannot_blow_are_reported() {
    let nan = f32::NAN;
    assert_said(WindField::steady(Vec3::new(1.0, nan, 0.0)), &["WindField", "velocity of NaN"]);
    let gusty = WindField::default().with_gusts(f32::INFINITY, 0.5, 1);
    assert_said(gusty, &["gust_strength of inf"]);
    assert_said(WindFan::new(8.0, -0.4), &["WindFan", "radius of -0.4", "not negative"]);
    let blast = WindBlast { duration: 0.0, ..WindBlast::default() };
    assert_said(blast, &["WindBlast", "duration of 0", "greater than zero"]);
    assert_said(WindWake::new(nan), &["WindWake", "drag_area"]);
    let region = (WindField::default(), WindRegion::ball(-2.0, 1.0));
    assert_said(region, &["WindRegion", "radius of -2"]);
    let region = WindRegion::cuboid(Vec3::new(1.0, nan, 1.0), 1.0);
    assert_said((WindField::default(), region), &["half_extents of NaN"]);
}

#[test]
fn a_region_without_a_field_is_reported() {
    assert_said(WindRegion::default(), &["bounds no wind", "WindField"]);
}

#[test]
fn good_winds_are_not_reported() {
    let good = (
        WindField::steady(Vec3::X).with_gusts(1.0, 0.5, 1),
        WindRegion::default(),
        WindFan::default(),
        WindBlast::default(),
        WindWake::default(),
    );
    assert_eq!(messages(good), [""; 0]);
    // A fan that is switched off, and a draught that is shut.
    assert_eq!(messages((WindFan::new(0.0, 0.0), WindBlast::new(0.0, 0.0))), [""; 0]);
}

#[test]
fn colliders_that_cannot_be_are_reported() {
    let [infinite, negative, nan] = [f32::INFINITY, -0.5, f32::NAN];
    let ball = ClothCollider::ball;
    assert_said(ClothCollider { margin: infinite, ..ball(1.0) }, &["margin", "inf"]);
    assert_said(ClothCollider { friction: nan, ..ball(1.0) }, &["friction", "NaN"]);
    assert_said(ball(negative), &["ClothCollider", "extent cannot be -1"]);
    assert_said(ball(nan), &["extent cannot be NaN"]);
    assert_said(ClothCollider::capsule(0.5, negative), &["extent cannot be -1"]);
    for good in [ball(0.0), ClothCollider::ground(), ClothCollider::cuboid(Vec3::ONE)] {
        assert_eq!(messages(good), [""; 0]);
    }
}

#[test]
fn a_scale_that_a_collider_cannot_have_is_reported_once() {
    let mirrored = || Transform::from_scale(Vec3::new(-1.0, 1.0, 1.0));
    let corners = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
    let hull = || ClothCollider::convex_hull(&corners).expect("a hull");
    assert_said((hull(), mirrored()), &["scale [-1, 1, 1]", "ScaleInShape"]);
    assert_eq!(messages((hull(), mirrored(), ScaleInShape)), [""; 0]);
    // What is its own mirror image can have it.
    assert_eq!(messages((ClothCollider::ball(0.5), mirrored())), [""; 0]);
    let mut app = app();
    let parent = app.world_mut().spawn(mirrored()).id();
    let child = app.world_mut().spawn((hull(), ChildOf(parent))).id();
    let grows = app.world_mut().spawn(hull()).id();
    run(&mut app, 3);
    assert_eq!(failures(&app).iter().map(|it| it.entity).collect::<Vec<_>>(), [child]);
    for tick in 0..5 {
        let mut pose = app.world_mut().get_mut::<Transform>(grows).expect("a pose");
        let scale = Vec3::new(-1.0 - tick as f32, 1.0, 1.0);
        *pose = Transform::from_xyz(0.0, tick as f32, 0.0).with_scale(scale);
        run(&mut app, 1);
    }
    assert_eq!(failures(&app).iter().map(|it| it.entity).collect::<Vec<_>>(), [child, grows]);
}

#[test]
fn an_attachment_of_no_cloth_is_reported() {
    assert_said(Attachment::in_place(ClothEdge::Left), &["holds nothing", "ClothMesh"]);
    // What becomes a cloth in the same frame does not.
    let mut app = app();
    let cloth = app.world_mut().spawn(Attachment::in_place(ClothEdge::Left)).id();
    app.world_mut().entity_mut(cloth).insert(FLAG);
    run(&mut app, 3);
    assert!(failures(&app).is_empty());
}

/// Two triangles of a square, of which the second is turned.
fn turned() -> ClothMesh {
    let corners = [Vec2::ZERO, Vec2::X, -Vec2::Y, Vec2::new(1.0, -1.0)];
    let positions = corners.map(|at| at.extend(0.0)).to_vec();
    ClothMesh::triangles(positions, vec![0, 2, 1, 1, 3, 2], Vec::new())
}

#[test]
fn mixed_winding_is_no_one_sided_mesh() {
    let held = || Attachment::in_place(AttachedVertices::List(vec![0, 1]));
    assert_said((turned(), held()), &["from vertex 1 to 2", "opposite sides", "repaired"]);
    let (repaired, _) = turned().repaired().expect("a mesh that can be repaired");
    assert_eq!(messages((repaired, held())), [""; 0]);
    // Five triangles around a hole with half a turn: a Möbius strip.
    let corner = |at: u32| Vec3::from([at, at * at, at % 2].map(|it| it as f32));
    let strip = [0, 1, 2, 1, 2, 3, 2, 3, 4, 3, 4, 0, 4, 0, 1].to_vec();
    let strip = ClothMesh::triangles((0..5).map(corner).collect(), strip, Vec::new());
    assert_said((strip, held()), &["Möbius"]);
}

#[test]
fn gravity_that_is_not_a_number_is_logged() {
    logged();
    let mut app = app();
    app.world_mut().resource_mut::<ClothSettings>().gravity = Vec3::new(0.0, f32::NAN, 0.0);
    let flag = app.world_mut().spawn(FLAG).id();
    run(&mut app, 5);
    assert!(logged().iter().any(|it| it.contains("gravity [0, NaN, 0]")), "{:?}", logged());
    assert_finite(&app, flag);
}

#[test]
fn layers_thicker_than_the_cloth_are_logged_once_and_touch_nothing() {
    let mut app = app();
    let sheet = |thickness| (FLAG, SelfCollision { thickness, ..Default::default() });
    let [thick, free] = [app.world_mut().spawn(sheet(20.9)).id(), app.world_mut().spawn(FLAG).id()];
    logged();
    run(&mut app, 30);
    let of_thickness = || logged().into_iter().filter(|it| it.contains("20.9 m")).count();
    assert_eq!(of_thickness(), 1);
    let positions = |app: &App, cloth| state(app, cloth).positions().to_vec();
    assert_eq!(positions(&app, thick), positions(&app, free));
    app.world_mut().get_mut::<SelfCollision>(thick).expect("a component").thickness = 30.9;
    run(&mut app, 1);
    assert!(logged().iter().any(|it| it.contains("30.9 m")), "a change is told again");
}
