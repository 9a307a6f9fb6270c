//! Hands of pointers, which drag cloths.

use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_math::prelude::InfinitePlane3d;
use bevy_picking::backend::ray::{RayId, RayMap};
use bevy_picking::events::{Pointer, Press};
use bevy_picking::pointer::{PointerButton, PointerId, PointerMap, PointerPress};
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bevy_transform::components::{GlobalTransform, Transform};

use crate::anchors::grab::ClothGrab;
use crate::cloth::mesh::ClothMesh;
use crate::picking::backend::ClothHit;
use crate::picking::pins::PinBrush;

/// How pointers drag cloths.
///
/// ```
/// use bevy_bunting::prelude::*;
///
/// // A weak hand: what pulls harder than 5 N is drawn along no further.
/// let weak = ClothDragSettings { max_force: 5.0, ..ClothDragSettings::default() };
/// # assert_eq!(weak.radius, 0.05);
/// ```
#[derive(Resource, Clone, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Resource, Default, Debug, PartialEq, Clone)]
pub struct ClothDragSettings {
    /// Radius within which vertices are grabbed, m; those of the triangle under the pointer always are.
    pub radius: f32,
    /// Stiffness of the hold, N/m, of all vertices together.
    pub stiffness: f32,
    /// Greatest force, N. May be infinite.
    pub max_force: f32,
}

impl Default for ClothDragSettings {
    fn default() -> Self {
        Self { radius: 0.05, stiffness: 200.0, max_force: 40.0 }
    }
}

/// The hand of a pointer that drags a cloth, spawned where the pointer has pressed, with a [`ClothGrab`]; despawned when it
/// lets go. It moves in the plane through itself that is parallel to the picture of the camera.
#[derive(Component, Clone, Copy, Debug, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Debug, Clone)]
#[require(Transform)]
pub struct ClothDrag {
    /// The pointer.
    pub pointer: PointerId,
    /// The camera in whose picture the pointer is.
    #[entities]
    pub camera: Entity,
}

/// How much farther than the corners of the triangle a hand reaches: cloth moves until the next tick.
const SLACK: f32 = 1.1;

/// Grabs the cloth that a pointer presses with its primary button.
pub(super) fn grab(
    press: On<Pointer<Press>>,
    cloths: Query<(), With<ClothMesh>>,
    settings: Res<ClothDragSettings>,
    brush: Res<PinBrush>,
    mut commands: Commands,
) {
    let cloth = press.original_event_target();
    let is_first = press.entity == cloth && press.button == PointerButton::Primary;
    let is_first = is_first && !brush.paints(cloth);
    let Some(at) = press.hit.position.filter(|_| is_first && cloths.contains(cloth)) else {
        return;
    };
    let corners = press.hit.extra_as::<ClothHit>().map_or(0.0, |hit| SLACK * hit.corners);
    let radius = settings.radius.max(corners);
    commands.spawn((
        ClothDrag { pointer: press.pointer_id, camera: press.hit.camera },
        ClothGrab::within(cloth, radius).with_strength(settings.stiffness, settings.max_force),
        Transform::from_translation(at),
    ));
}

/// Moves hands with their pointers, and lets go where the button is not pressed any more, or the pointer or the cloth is
/// gone.
pub(super) fn drag(
    mut hands: Query<(Entity, &ClothDrag, &ClothGrab, &mut Transform)>,
    cloths: Query<(), With<ClothMesh>>,
    rays: Res<RayMap>,
    pointers: Res<PointerMap>,
    presses: Query<&PointerPress>,
    cameras: Query<&GlobalTransform>,
    mut commands: Commands,
) {
    for (hand, drag, grab, mut transform) in &mut hands {
        let press = pointers.get_entity(drag.pointer).and_then(|it| presses.get(it).ok());
        if !press.is_some_and(PointerPress::is_primary_pressed) || !cloths.contains(grab.cloth) {
            commands.entity(hand).despawn();
            continue;
        }
        let ray = rays.map.get(&RayId::new(drag.camera, drag.pointer));
        let (Some(ray), Ok(camera)) = (ray, cameras.get(drag.camera)) else { continue };
        let plane = InfinitePlane3d::new(camera.forward());
        let Some(distance) = ray.intersect_plane(transform.translation, plane) else { continue };
        let at: Vec3 = ray.get_point(distance);
        if at.is_finite() && at != transform.translation {
            transform.translation = at;
        }
    }
}
