//! Tests of dragging by a pointer.

use bevy_math::Vec2;
use bevy_picking::Pickable;
use bevy_picking::pointer::{PointerAction, PointerButton};

use crate::picking::tests::Scene;

#[test]
fn a_pointer_drags_the_cloth_under_it_and_lets_go() {
    let mut scene = Scene::new(());
    let before = scene.middle();
    scene.point_at(Vec2::new(0.01, -0.01));
    scene.run(1);
    scene.send(PointerAction::Press(PointerButton::Primary));
    scene.run(2);
    assert_eq!(scene.hands(), 1);
    for step in 1..=60 {
        scene.point_at(Vec2::new(0.01 + 0.005 * step as f32, -0.01));
        scene.run(1);
    }
    scene.run(60);
    let drawn = scene.middle() - before;
    assert!((drawn.x - 0.3).abs() < 0.08, "{drawn} m for 0.3 m across");
    scene.send(PointerAction::Release(PointerButton::Primary));
    scene.run(2);
    assert_eq!(scene.hands(), 0);
    scene.run(600);
    assert!(scene.middle().distance(before) < 0.05, "{}", scene.middle());
}

#[test]
fn other_buttons_other_places_and_ignored_cloths_are_not_dragged() {
    let pressed = |curtain: bool, at: Vec2, button: PointerButton| {
        let pickable = if curtain { Pickable::default() } else { Pickable::IGNORE };
        let mut scene = Scene::new(pickable);
        scene.point_at(at);
        scene.run(1);
        scene.send(PointerAction::Press(button));
        scene.run(2);
        scene.hands()
    };
    assert_eq!(pressed(true, Vec2::ZERO, PointerButton::Primary), 1);
    assert_eq!(pressed(true, Vec2::ZERO, PointerButton::Secondary), 0);
    assert_eq!(pressed(true, Vec2::X * 0.6, PointerButton::Primary), 0);
    assert_eq!(pressed(false, Vec2::ZERO, PointerButton::Primary), 0);
}

#[test]
fn a_cloth_that_is_despawned_in_a_drag_is_let_go() {
    let mut scene = Scene::new(());
    scene.point_at(Vec2::ZERO);
    scene.run(1);
    scene.send(PointerAction::Press(PointerButton::Primary));
    scene.run(2);
    scene.app.world_mut().despawn(scene.curtain);
    scene.run(2);
    assert_eq!(scene.hands(), 0);
}
