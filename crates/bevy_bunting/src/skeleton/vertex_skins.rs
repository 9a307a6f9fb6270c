//! The last valid skin of a cloth, vertex by vertex.

use bevy_math::Vec3;
use bunting_solver::Backstop;

use crate::cloth::mesh::ClothMesh;
use crate::skeleton::limits::{SkinLimits, VertexLimits};
use crate::skeleton::particles::SkinnedParticle;
use crate::skeleton::skin::{ClothSkin, SkinError};

/// A valid skin and its limits, which are kept while the cloth's present ones are invalid.
#[derive(Debug, Default)]
pub(crate) struct VertexSkins {
    pub skin: ClothSkin,
    /// None where there are no limits.
    pub limits: Option<VertexLimits>,
    /// Unit normals of the mesh at rest.
    normals: Vec<Vec3>,
    /// Weights with which simulated positions are shown; empty where all are 1.
    shown: Vec<f32>,
}

impl VertexSkins {
    /// The skin of a mesh. None if the mesh itself is invalid, which is reported where its fabrics are built.
    ///
    /// # Errors
    ///
    /// The skin or the limits do not fit the mesh, or have numbers that are out of range.
    pub fn of(
        mesh: &ClothMesh,
        skin: &ClothSkin,
        limits: Option<&SkinLimits>,
    ) -> Result<Option<Self>, SkinError> {
        skin.validate(mesh.vertex_count())?;
        let limits = limits.map(|limits| limits.of(mesh)).transpose()?;
        let Ok(normals) = mesh.builder().rest_normals() else { return Ok(None) };
        Ok(Some(Self { skin: skin.clone(), limits, normals, shown: mesh.weights().to_vec() }))
    }

    /// Number of vertices.
    pub fn vertex_count(&self) -> usize {
        self.normals.len()
    }

    /// The particle of a vertex, without its position. A vertex that the skin does not have follows no joint.
    pub(super) fn particle(&self, vertex: usize) -> SkinnedParticle {
        let weights = self.skin.joint_weights.get(vertex).copied().unwrap_or_default();
        let sum: f32 = weights.iter().sum();
        let limit = |of: fn(&VertexLimits) -> &Vec<f32>, none: f32| {
            self.limits.as_ref().and_then(|limits| of(limits).get(vertex)).copied().unwrap_or(none)
        };
        let shown = self.shown.get(vertex).copied().unwrap_or(1.0);
        SkinnedParticle {
            rest: Vec3::ZERO,
            normal: self.normals.get(vertex).copied().unwrap_or_default(),
            joints: self.skin.joint_indices.get(vertex).copied().unwrap_or_default(),
            weights: weights.map(|weight| weight / sum.max(f32::MIN_POSITIVE)),
            max_distance: limit(|limits| &limits.max_distance, f32::INFINITY),
            backstop: Backstop {
                distance: limit(|limits| &limits.backstop_distance, 0.0),
                radius: limit(|limits| &limits.backstop_radius, 0.0),
            },
            simulated: shown * limit(|limits| &limits.simulated, 1.0),
        }
    }
}
