//! Vertices of a group that an artist has painted into a mesh.

use bevy_ecs::prelude::*;
use bevy_mesh::Mesh;
use bevy_reflect::Reflect;

use crate::cloth::error::ClothError;
use crate::motion::attached_vertices::AttachedVertices;
use crate::motion::attachment::Attachment;
use crate::render::painted_weights::VertexPaint;

/// The vertices of a mesh whose painted value is at least [`least`](Self::least): those that one anchor holds, see
/// [`ClothFromMesh::held`](crate::ClothFromMesh).
///
/// ```
/// use bevy_bunting::prelude::*;
///
/// // A vertex group that Blender has exported as an attribute.
/// let paint = VertexPaint::Attribute("Left shoulder".to_owned());
/// let held = vec![PaintedVertices { paint, least: 0.5 }];
/// let cape = ClothFromMesh { held, ..ClothFromMesh::default() };
/// # assert_eq!(cape.held.len(), 1);
/// ```
#[derive(Clone, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Debug, PartialEq, Clone)]
pub struct PaintedVertices {
    /// Where the mesh has the values.
    pub paint: VertexPaint,
    /// Least value of a vertex that belongs to the group.
    pub least: f32,
}

impl PaintedVertices {
    /// The vertices of a mesh, by index.
    ///
    /// # Errors
    ///
    /// The mesh does not have the values in a format that can be read.
    pub(super) fn read(&self, entity: Entity, mesh: &Mesh) -> Result<Vec<u32>, ClothError> {
        let values = self.paint.values(entity, mesh)?;
        let chosen = (0..).zip(values).filter(|&(_, value)| value >= self.least);
        Ok(chosen.map(|(vertex, _)| vertex).collect())
    }
}

/// An attachment whose own vertices, and then those of its anchors, are the painted ones of a mesh, as far as there are
/// lists of these; none without any.
///
/// # Errors
///
/// The mesh does not have the values, or there are more lists than the attachment and its anchors can hold.
pub(super) fn painted_attachment(
    held: &[PaintedVertices],
    attachment: Option<&Attachment>,
    entity: Entity,
    mesh: &Mesh,
) -> Result<Option<Attachment>, ClothError> {
    if held.is_empty() {
        return Ok(None);
    }
    let holders = attachment.map_or(0, |attachment| 1 + attachment.anchors.len());
    let Some(attachment) = attachment.filter(|_| held.len() <= holders) else {
        return Err(ClothError::PaintedNotHeld { entity, painted: held.len(), holders });
    };
    let mut attachment = attachment.clone();
    let anchored = attachment.anchors.iter_mut().map(|anchor| &mut anchor.vertices);
    let vertices = core::iter::once(&mut attachment.vertices).chain(anchored);
    for (vertices, painted) in vertices.zip(held) {
        *vertices = AttachedVertices::List(painted.read(entity, mesh)?);
    }
    Ok(Some(attachment))
}
