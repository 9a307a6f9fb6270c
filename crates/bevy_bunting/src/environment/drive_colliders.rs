//! Sets the colliders that each cloth may touch in a tick.

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;
use bevy_math::{Isometry3d, Quat, Vec3};
use bevy_time::Time;
use bunting_solver::Collider;

use crate::batch::batches::ClothBatches;
use crate::cloth::instance::ClothInstance;
use crate::cloth::reflect::SharedShapeReflect;
use crate::environment::collider::ClothCollider;
use crate::environment::collider_tree::{
    ColliderTree, forget_collider, in_world, shift_tree, update_tree,
};
use crate::environment::drive::drive_cloths;
use crate::environment::layers::{ClothFeatures, ClothLayers};
use crate::environment::reactions::ClothReactions;
use crate::environment::report_colliders::{ScaleInShape, report_colliders};
use crate::environment::scale_shapes::{scale_again, scale_shapes};
use crate::environment::scaled_shape::ScaledShape;
use crate::environment::shapes_in_units::ShapesInUnits;
use crate::motion::observe::observe_ticks;
use crate::motion::pose::{PoseHistory, pose_parts};
use crate::schedule::{ClothSystems, ClothTick};

/// Gives each cloth the [`ClothCollider`]s that it may touch.
#[derive(Debug, Default)]
pub struct ColliderPlugin;

impl Plugin for ColliderPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<ClothCollider>()
            .register_type::<ClothLayers>()
            .register_type::<ClothFeatures>()
            .register_type::<ScaleInShape>()
            .register_type::<SharedShapeReflect>()
            .init_resource::<ColliderTree>()
            .add_observer(forget_collider)
            .add_observer(shift_tree)
            .add_observer(scale_again)
            .add_systems(
                ClothTick,
                (
                    (report_colliders, scale_shapes.after(observe_ticks))
                        .in_set(ClothSystems::Prepare),
                    (update_tree, drive_colliders)
                        .chain()
                        .in_set(ClothSystems::Drive)
                        .after(drive_cloths),
                ),
            );
        #[cfg(feature = "serialize")]
        app.register_type_data::<SharedShapeReflect, bevy_reflect::ReflectSerialize>()
            .register_type_data::<SharedShapeReflect, bevy_reflect::ReflectDeserialize>();
    }
}

/// A collider that a cloth may touch; the last item is whether it has [`ClothReactions`].
type NearCollider = (
    Entity,
    &'static ClothCollider,
    &'static ScaledShape,
    &'static PoseHistory,
    Option<&'static ClothLayers>,
    Has<ClothReactions>,
);

/// A cloth that may touch colliders.
type TouchingCloth = (
    Entity,
    &'static ClothInstance,
    &'static PoseHistory,
    Option<&'static ClothLayers>,
    Option<&'static ClothFeatures>,
);

/// Sets the colliders near each cloth, relative to the cloth's frame: their poses at the start of the tick
/// relative to the frame at that time, and their poses at its end likewise. Poses of entities that move in
/// frames are extrapolated to the time of the tick, of cloths and colliders alike, so that a collider that
/// moves with a cloth rests in its frame.
pub(super) fn drive_colliders(
    colliders: Query<NearCollider>,
    cloths: Query<TouchingCloth>,
    tree: Res<ColliderTree>,
    time: Res<Time>,
    mut batches: ResMut<ClothBatches>,
    mut had_any: Local<bool>,
    mut shapes: Local<ShapesInUnits>,
) {
    let has_any = !tree.is_empty();
    if !has_any && !*had_any {
        return;
    }
    *had_any = has_any;
    batches.update_bounds(time.delta_secs());
    for (cloth, instance, frame, layers, features) in &cloths {
        let Some(lane) = instance.lane() else { continue };
        let (start, end) = frame.extrapolated();
        let growth = &instance.growth;
        let bounds = batches.bounds(lane).map(|bounds| growth.bounds(&bounds));
        let bounds = bounds.map(|bounds| in_world(&bounds, (start, end)));
        let near = bounds.iter().flat_map(|bounds| tree.near(bounds));
        let (start, end) = (start.inverse(), end.inverse());
        let layers = layers.copied().unwrap_or_default();
        let has_features = instance.level < features.copied().unwrap_or_default().levels;
        let colliders = colliders.iter_many(near).filter_map(|near| {
            let (entity, collider, shape, pose, of_collider, reacts) = near;
            let touch = layers.touch(of_collider.copied().unwrap_or_default());
            let (from, to) = touch.then(|| pose.extrapolated())?;
            let (from, to) = (relative_pose(start, from), relative_pose(end, to));
            let [at_start, at_end] = growth.places([from.0, to.0]);
            let (from, to) = ((at_start, from.1), (at_end, to.1));
            let own = &collider.shape;
            let collider = if growth.end() == 1.0 {
                collider.between(shape.of(own), from, to)
            } else {
                let scale = shape.scale() / growth.end();
                let shape = shapes.shape((cloth, entity), own, scale);
                let margin = collider.margin / growth.end();
                Collider { margin, ..collider.between(shape, from, to) }
            };
            Some(Collider {
                features: collider.features && has_features,
                reports_as: reacts.then(|| entity.to_bits()),
                ..collider
            })
        });
        batches.lane(lane).set_colliders(colliders);
    }
    shapes.end_tick();
}

/// A pose relative to a frame, given the inverse of the frame's pose.
fn relative_pose(inverse_frame: Isometry3d, pose: Isometry3d) -> (Vec3, Quat) {
    let (translation, rotation) = pose_parts(inverse_frame * pose);
    (translation, rotation.normalize())
}
