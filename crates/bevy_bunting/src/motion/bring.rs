//! Brings the first of held vertices to their targets, once their mesh is known.

use bevy_ecs::prelude::*;
use bevy_transform::components::Transform;
use bevy_transform::helper::TransformHelper;

use crate::cloth::instance::ClothInstance;
use crate::cloth::mesh::ClothMesh;
use crate::fabric::scale::{ScaleBaked, scale_of};
use crate::motion::attached_vertices::AttachedVertices;
use crate::motion::attachment::Attachment;
use crate::skeleton::skin::ClothSkin;

type BroughtCloth = (
    Entity,
    &'static ClothMesh,
    &'static mut Attachment,
    &'static ClothInstance,
    (Has<ScaleBaked>, Has<ClothSkin>),
);

/// Filter of cloths that may be held at new places.
type MayBeNew = Or<(Changed<Attachment>, Added<ClothMesh>)>;

/// Sets the offsets of attachments and anchors that bring a vertex to their target. One whose target or scale is not known
/// waits, and holds nothing meanwhile.
pub(super) fn bring_vertices(
    mut cloths: Query<BroughtCloth, MayBeNew>,
    transforms: TransformHelper,
) {
    for (entity, mesh, mut attachment, instance, (has_baked, has_skin)) in &mut cloths {
        if !attachment.brings_any() {
            continue;
        }
        // A scale that cannot be is reported where the fabric is built.
        let size = instance.growth.end();
        let has_scale = has_baked || has_skin;
        let scale = scale_of(entity, Some(&attachment), has_scale, size, &transforms);
        let Ok(scale) = scale.map(|scale| size * scale) else { continue };
        let place = |vertices: &AttachedVertices| vertices.first_place(mesh).map(|at| scale * at);
        let offset = |target: Entity, vertices: &AttachedVertices, offset: Transform| {
            let target = transforms.compute_global_transform(target).ok()?;
            let way = offset.rotation * place(vertices)?;
            let translation = offset.translation - way / target.scale();
            Some(Transform { translation, ..offset })
        };
        let attachment = &mut *attachment;
        if attachment.brings_first {
            let Attachment { vertices, offset: at, .. } = &*attachment;
            let brought = match attachment.target_other_than(entity) {
                Some(target) => offset(target, vertices, *at),
                None => Some(*at),
            };
            if let Some(brought) = brought {
                (attachment.offset, attachment.brings_first) = (brought, false);
            }
        }
        for anchor in attachment.anchors.iter_mut().filter(|anchor| anchor.brings_first) {
            if let Some(brought) = offset(anchor.target, &anchor.vertices, anchor.offset) {
                (anchor.offset, anchor.brings_first) = (brought, false);
            }
        }
    }
}
