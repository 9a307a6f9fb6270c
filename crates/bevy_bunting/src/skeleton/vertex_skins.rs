//! The last valid skin of a cloth, vertex by vertex.

use bevy_math::Vec3;
use bunting_solver::Backstop;

use crate::cloth::mesh::ClothMesh;
use crate::skeleton::limits::{SkinLimits, VertexLimits};
use crate::skeleton::skin::{ClothSkin, SkinError};
use crate::skeleton::skinned_particle::SkinnedParticle;

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

    /// A particle between vertices with weights whose sum is 1, without its position. Vertices that the skin does not have follow
    /// no joint.
    pub(super) fn particle(&self, corners: impl Iterator<Item = (u32, f32)>) -> SkinnedParticle {
        let mut joints = Vec::new();
        let mut particle = SkinnedParticle {
            rest: Vec3::ZERO,
            normal: Vec3::ZERO,
            joints: [0; 4],
            weights: [0.0; 4],
            max_distance: 0.0,
            backstop: Backstop { distance: 0.0, radius: 0.0 },
            simulated: 0.0,
        };
        for (vertex, part) in corners {
            let vertex = vertex as usize;
            let limit = |of: fn(&VertexLimits) -> &Vec<f32>, none: f32| {
                let known = self.limits.as_ref().and_then(|limits| of(limits).get(vertex));
                part * known.copied().unwrap_or(none)
            };
            let shown = self.shown.get(vertex).copied().unwrap_or(1.0);
            particle.normal += part * self.normals.get(vertex).copied().unwrap_or_default();
            particle.max_distance += limit(|limits| &limits.max_distance, f32::INFINITY);
            particle.backstop.distance += limit(|limits| &limits.backstop_distance, 0.0);
            particle.backstop.radius += limit(|limits| &limits.backstop_radius, 0.0);
            particle.simulated += shown * limit(|limits| &limits.simulated, 1.0);
            self.add_joints(&mut joints, vertex, part);
        }
        particle.normal = particle.normal.normalize_or_zero();
        // The sort is stable, and joints of one vertex stay in their order.
        if joints.len() > particle.joints.len() {
            joints.sort_by(|one, other| other.1.total_cmp(&one.1));
            joints.truncate(particle.joints.len());
            let sum: f32 = joints.iter().map(|joint| joint.1).sum();
            joints.iter_mut().for_each(|joint| joint.1 /= sum);
        }
        for (at, joint) in joints.into_iter().enumerate() {
            (particle.joints[at], particle.weights[at]) = joint;
        }
        particle
    }

    /// Adds a part of the joints of a vertex.
    fn add_joints(&self, joints: &mut Vec<(u16, f32)>, vertex: usize, part: f32) {
        let weights = self.skin.joint_weights.get(vertex).copied().unwrap_or_default();
        let of_vertex = self.skin.joint_indices.get(vertex).copied().unwrap_or_default();
        let sum: f32 = weights.iter().sum();
        for (joint, weight) in of_vertex.into_iter().zip(weights).filter(|it| it.1 > 0.0) {
            let weight = part * (weight / sum);
            match joints.iter_mut().find(|known| known.0 == joint) {
                Some(known) => known.1 += weight,
                None => joints.push((joint, weight)),
            }
        }
    }
}
