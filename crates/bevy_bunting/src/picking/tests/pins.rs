//! Tests of painting pins.

use bevy_ecs::prelude::*;
use bevy_math::{Vec2, Vec3};
use bevy_picking::pointer::{PointerAction, PointerButton};
use bevy_transform::prelude::*;

use crate::picking::tests::Scene;
use crate::prelude::*;

/// Distance of two vertices, m.
const SPACING: f32 = 1.0 / 16.0;

/// The vertices of a row, from one column to another.
fn row(row: u32, columns: core::ops::RangeInclusive<u32>) -> impl Iterator<Item = u32> {
    columns.map(move |column| row * 17 + column)
}

impl Scene {
    fn brush(&mut self, stroke: PinStroke, radius: f32) {
        self.app.insert_resource(PinBrush { stroke, radius, only: None });
    }

    /// Presses at a place, moves to another one, and lets go.
    fn draw(&mut self, from: Vec2, to: Vec2) {
        self.point_at(from);
        self.run(1);
        self.send(PointerAction::Press(PointerButton::Primary));
        self.run(2);
        for step in 1..=32 {
            self.point_at(from.lerp(to, step as f32 / 32.0));
            self.run(1);
        }
        self.send(PointerAction::Release(PointerButton::Primary));
        self.run(2);
    }

    /// The vertices of the attachment; none if there is none.
    fn pins(&self) -> Option<AttachedVertices> {
        self.app.world().get::<Attachment>(self.curtain).map(|it| it.vertices.clone())
    }
}

#[test]
fn a_stroke_pins_the_vertices_along_it_and_an_eraser_frees_them() {
    let mut scene = Scene::new(ClothPaused);
    // The fourth column of vertices from the middle, in the row through the middle.
    let at = |column: f32| Vec2::new(SPACING * column, 0.0);
    scene.brush(PinStroke::Paint, 0.0);
    scene.draw(at(0.0), at(4.0));
    let painted: Vec<u32> = row(0, 0..=16).chain(row(8, 8..=12)).collect();
    assert_eq!(scene.pins(), Some(AttachedVertices::List(painted)));
    assert_eq!(scene.hands(), 0, "what is painted is not dragged");

    // From now on the button is up.
    scene.point_at(at(-4.0));
    scene.run(2);
    scene.brush(PinStroke::Erase, 1.5 * SPACING);
    scene.draw(at(2.0), at(2.0));
    let left: Vec<u32> = row(0, 0..=16).chain([8 * 17 + 8, 8 * 17 + 12]).collect();
    assert_eq!(scene.pins(), Some(AttachedVertices::List(left)));
}

#[test]
fn painted_vertices_are_held_where_the_mesh_has_them() {
    let mut scene = Scene::new(());
    scene.brush(PinStroke::Paint, 0.0);
    scene.point_at(scene.middle().truncate());
    scene.run(1);
    scene.send(PointerAction::Press(PointerButton::Primary));
    scene.run(2);
    scene.send(PointerAction::Release(PointerButton::Primary));
    scene.brush(PinStroke::Off, 0.0);
    scene.run(150);
    let off = scene.middle().distance(Vec3::ZERO);
    assert!(off < 1e-5, "the middle is pinned {off} m from its place");
}

#[test]
fn the_brush_reaches_metres_of_a_scaled_cloth_and_paints_the_only_one() {
    // A mesh of half the size, twice as large.
    let small = ClothMesh::grid(17, 17, 0.5, 0.5);
    let place = Transform::from_xyz(-0.5, 0.5, 0.0).with_scale(Vec3::splat(2.0));
    let mut scene = Scene::new(ClothPaused);
    scene.app.world_mut().entity_mut(scene.curtain).insert((small, place));
    scene.run(2);
    scene.brush(PinStroke::Paint, 1.1 * SPACING);
    scene.app.world_mut().resource_mut::<PinBrush>().only = Some(Entity::PLACEHOLDER);
    scene.draw(Vec2::ZERO, Vec2::ZERO);
    assert_eq!(scene.pins(), Some(ClothEdge::Top.into()), "another cloth is painted");
    scene.app.world_mut().resource_mut::<PinBrush>().only = Some(scene.curtain);
    scene.draw(Vec2::ZERO, Vec2::ZERO);
    let around = row(7, 8..=8).chain(row(8, 7..=9)).chain(row(9, 8..=8));
    let painted = row(0, 0..=16).chain(around).collect();
    assert_eq!(scene.pins(), Some(AttachedVertices::List(painted)));
}

#[test]
fn the_last_pin_that_is_erased_frees_the_cloth_and_a_new_one_holds_it() {
    let mut scene = Scene::new(ClothPaused);
    scene.brush(PinStroke::Erase, 2.0);
    scene.draw(Vec2::ZERO, Vec2::ZERO);
    assert_eq!(scene.pins(), None);
    scene.brush(PinStroke::Paint, 0.0);
    scene.draw(Vec2::ZERO, Vec2::ZERO);
    assert_eq!(scene.pins(), Some(AttachedVertices::List(vec![8 * 17 + 8])));
}
