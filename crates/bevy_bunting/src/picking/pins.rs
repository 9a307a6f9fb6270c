//! Pins that pointers paint.

use std::collections::BTreeSet;

use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemParam;
use bevy_picking::backend::HitData;
use bevy_picking::events::{Move, Pointer, Press};
use bevy_picking::pointer::{PointerButton, PointerMap, PointerPress};
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bunting_solver::{FabricBuilder, MeshPoint};

use crate::cloth::instance::ClothInstance;
use crate::cloth::mesh::ClothMesh;
use crate::fabric::scale::bake;
use crate::motion::attached_vertices::AttachedVertices;
use crate::motion::attachment::Attachment;
use crate::picking::backend::ClothHit;

/// What a pointer does to the pins of a cloth.
///
/// ```
/// use bevy_bunting::prelude::*;
///
/// // The right button of a tool: free what the left one has pinned.
/// let brush = PinBrush { stroke: PinStroke::Erase, ..PinBrush::default() };
/// # assert_ne!(brush, PinBrush::default());
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Default, Debug, PartialEq, Clone)]
pub enum PinStroke {
    /// Nothing: it drags the cloth.
    #[default]
    Off,
    /// It pins vertices.
    Paint,
    /// It frees pinned vertices.
    Erase,
}

/// How pointers paint pins: while the primary button is pressed, the vertices under the pointer are added to those of
/// the cloth's [`Attachment`], or removed from them. [`ClothDragPlugin`](crate::ClothDragPlugin) does both.
///
/// Painted vertices become an [`AttachedVertices::List`], or beside points [`AttachedVertices::Points`]; those of further anchors
/// stay theirs. They are held where
/// all attached vertices are, at their places in the [`ClothMesh`] seen from the cloth's frame, and move there
/// gently. A cloth without an [`Attachment`] gets one to its own `Transform`; one whose last pin is erased loses it,
/// unless it has further anchors.
///
/// ```
/// use bevy_bunting::prelude::*;
/// use bevy_ecs::prelude::*;
///
/// let mut world = World::new();
/// // Pointers pin what is within 10 cm.
/// let brush = PinBrush { stroke: PinStroke::Paint, radius: 0.1, ..PinBrush::default() };
/// world.insert_resource(brush);
/// ```
#[derive(Resource, Clone, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Resource, Default, Debug, PartialEq, Clone)]
pub struct PinBrush {
    /// Whether pointers paint, erase or drag.
    pub stroke: PinStroke,
    /// Radius at rest within which vertices are painted, m; the vertex nearest to the pointer always is.
    pub radius: f32,
    /// The only cloth that is painted; all, if none is named. Others are dragged.
    pub only: Option<Entity>,
}

impl Default for PinBrush {
    fn default() -> Self {
        Self { stroke: PinStroke::Off, radius: 0.05, only: None }
    }
}

impl PinBrush {
    /// Whether a cloth is painted, not dragged.
    pub(super) fn paints(&self, cloth: Entity) -> bool {
        self.stroke != PinStroke::Off && self.only.is_none_or(|only| only == cloth)
    }
}

/// Paints where a pointer presses its primary button.
pub(super) fn begin(press: On<Pointer<Press>>, mut paint: PaintPins) {
    if press.entity == press.original_event_target() && press.button == PointerButton::Primary {
        paint.stroke(press.entity, &press.hit);
    }
}

/// Paints where a pointer moves while its primary button is pressed.
pub(super) fn go_on(
    at: On<Pointer<Move>>,
    pointers: Res<PointerMap>,
    presses: Query<&PointerPress>,
    mut paint: PaintPins,
) {
    let press = pointers.get_entity(at.pointer_id).and_then(|it| presses.get(it).ok());
    let is_pressed = press.is_some_and(PointerPress::is_primary_pressed);
    if at.entity == at.original_event_target() && is_pressed {
        paint.stroke(at.entity, &at.hit);
    }
}

type Painted = (&'static ClothMesh, &'static ClothInstance, Option<&'static mut Attachment>);

/// What is painted, and with what.
#[derive(SystemParam)]
pub(super) struct PaintPins<'w, 's> {
    brush: Res<'w, PinBrush>,
    cloths: Query<'w, 's, Painted>,
    commands: Commands<'w, 's>,
}

impl PaintPins<'_, '_> {
    /// Paints around a point of a cloth. Nothing changes unless a vertex does: a new attachment is a new fabric.
    fn stroke(&mut self, cloth: Entity, hit: &HitData) {
        let Ok((mesh, instance, attachment)) = self.cloths.get_mut(cloth) else { return };
        let Some(hit) = hit.extra_as::<ClothHit>().filter(|_| self.brush.paints(cloth)) else {
            return;
        };
        let held = attachment.as_ref().map(|it| it.vertices.choose(mesh));
        let held: BTreeSet<u32> = held.into_iter().flatten().collect();
        let points = attachment.iter().flat_map(|it| it.vertices.points());
        let points: Vec<MeshPoint> = points.collect();
        let builder = bake(mesh, instance.scale).builder();
        let (near, reach) = near(&builder, hit, self.brush.radius / instance.growth.end());
        let mut kept = points.clone();
        let pins: BTreeSet<u32> = match self.brush.stroke {
            PinStroke::Off => return,
            PinStroke::Paint => held.union(&near).copied().collect(),
            PinStroke::Erase => {
                let place = |point: &MeshPoint| builder.place(point);
                kept.retain(|it| place(it).is_none_or(|at| at.distance(hit.at_rest) > reach));
                held.difference(&near).copied().collect()
            }
        };
        if pins == held && kept == points {
            return;
        }
        let is_free = pins.is_empty() && kept.is_empty();
        let vertices = if kept.is_empty() {
            AttachedVertices::List(pins.into_iter().collect())
        } else {
            kept.extend(pins.into_iter().map(MeshPoint::at_vertex));
            AttachedVertices::Points(kept)
        };
        match attachment {
            Some(it) if is_free && it.anchors.is_empty() => {
                self.commands.entity(cloth).remove::<Attachment>();
            }
            Some(mut it) => it.vertices = vertices,
            None => {
                self.commands.entity(cloth).insert(Attachment::in_place(vertices));
            }
        }
    }
}

/// The vertices of a mesh within a radius (m), and the nearest one; and the distance (m) within which they lie. Distances are those at
/// rest, so that layers behind one another are not painted together. Vertices that the level of detail lacks are among them.
fn near(builder: &FabricBuilder, hit: &ClothHit, radius: f32) -> (BTreeSet<u32>, f32) {
    let distances = builder.positions().iter().map(|at| at.distance(hit.at_rest));
    let distances: Vec<f32> = distances.collect();
    let nearest = distances.iter().copied().fold(f32::INFINITY, f32::min);
    let reach = radius.max(nearest);
    let near = (0..).zip(distances).filter(|(_, distance)| *distance <= reach);
    (near.map(|(it, _)| it).collect(), reach)
}
