//! Conversion of a mesh as `ClothFromMesh` asks for it: with painted weights, repaired.

use bevy_asset::RenderAssetUsages;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_mesh::{Indices, Mesh};

use crate::cloth::error::ClothError;
use crate::cloth::mesh::ClothMesh;
use crate::cloth::weights::check_weights;
use crate::fabric::attached::Attached;
use crate::fabric::simulated::{SimulatedPart, renumbered};
use crate::render::cloth_from_mesh::ClothFromMesh;
use crate::render::level_mesh::with_vertices;
use crate::skeleton::by_vertex::ByVertex;
use crate::skeleton::limits::SkinLimits;

/// The cloth that a mesh becomes.
pub(super) struct Converted {
    pub shape: ClothMesh,
    /// The mesh that shows it.
    pub shown: Mesh,
}

impl ClothFromMesh {
    /// The limits of a skinned mesh with those that are painted; none if none are.
    pub(super) fn painted_limits(
        &self,
        limits: Option<&SkinLimits>,
        entity: Entity,
        mesh: &Mesh,
    ) -> Result<Option<SkinLimits>, ClothError> {
        let mut limits = limits.cloned().unwrap_or_default();
        let mut are_painted = false;
        for (painted, limit) in [
            (&self.max_distance, &mut limits.max_distance),
            (&self.backstop_radius, &mut limits.backstop_radius),
            (&self.backstop_distance, &mut limits.backstop_distance),
        ] {
            if let Some(painted) = painted {
                *limit = ByVertex::Each(painted.read(entity, mesh)?);
                are_painted = true;
            }
        }
        Ok(are_painted.then_some(limits))
    }

    /// The cloth of a mesh with a scale.
    pub(super) fn convert(
        &self,
        entity: Entity,
        mesh: &Mesh,
        scale: Vec3,
    ) -> Result<Converted, ClothError> {
        let is_kept = mesh.asset_usage.contains(RenderAssetUsages::MAIN_WORLD);
        if !is_kept || mesh.try_attribute_option(Mesh::ATTRIBUTE_POSITION).is_err() {
            return Err(ClothError::MeshUnreadable { entity });
        }
        let mut shown = mesh.clone();
        if scale != Vec3::ONE {
            shown.scale_by(scale);
            if scale.element_product() < 0.0 {
                // A mesh that is no list of triangles gives an empty cloth, which is reported later.
                let _ = shown.invert_winding();
            }
        }
        let mut shape = ClothMesh::from(&shown);
        if let (ClothMesh::Triangles { uv, .. }, true) = (&mut shape, self.ignore_uv) {
            uv.clear();
        }
        if let Some(painted) = &self.weights {
            shape = shape.with_weights(painted.read(entity, &shown)?);
        }
        // For each vertex, that of the given mesh, by which errors name it.
        let mut given: Option<Vec<u32>> = None;
        if self.repair {
            let repaired = shape.repaired();
            let (repaired, report) =
                repaired.map_err(|source| ClothError::Mesh { entity, source })?;
            shape = repaired;
            shown = with_vertices(shown, report.vertices.clone());
            given = Some(report.vertices);
            if let ClothMesh::Triangles { indices, .. } = &shape {
                shown.insert_indices(Indices::U32(indices.clone()));
            }
        }
        let vertex = |of: usize| {
            let given = given.as_ref().and_then(|given| given.get(of));
            given.map_or(of, |&vertex| vertex as usize)
        };
        check_shape(entity, &shape).map_err(|error| match error {
            ClothError::Mesh { entity, source } => {
                ClothError::Mesh { entity, source: renumbered(source, vertex, |it| it) }
            }
            other => other,
        })?;
        Ok(Converted { shape, shown })
    }
}

/// Checks whether fabrics can be built from a mesh, without building them.
fn check_shape(entity: Entity, shape: &ClothMesh) -> Result<(), ClothError> {
    check_weights(shape.weights(), shape.vertex_count())
        .map_err(|source| ClothError::Weights { entity, source })?;
    let defect = SimulatedPart::of(shape, &Attached::default()).and_then(|part| part.check());
    defect.map_err(|source| ClothError::Mesh { entity, source })
}
