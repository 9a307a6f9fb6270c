//! The reason why a cloth gets no fabrics, in terms of its mesh.

use bevy_ecs::prelude::*;
use bunting_solver::FabricError;

use crate::cloth::error::ClothError;
use crate::cloth::mesh::ClothMesh;

/// The error of a cloth from whose mesh no fabric can be built. The triangles of a mesh that can be repaired are only wound
/// differently, where those of a one-sided one cannot be wound alike.
pub(super) fn refusal(entity: Entity, mesh: &ClothMesh, source: FabricError) -> ClothError {
    match source {
        FabricError::OneSided { a, b } if mesh.clone().repaired().is_ok() => {
            ClothError::Winding { entity, a, b }
        }
        _ => ClothError::Mesh { entity, source },
    }
}
