//! Draws the figure as one skinned mesh, and dyes the cape.

use crate::render::{print, stage};
use bevy::asset::RenderAssetUsages;
use bevy::camera::visibility::NoFrustumCulling;
use bevy::mesh::skinning::{SkinnedMesh, SkinnedMeshInverseBindposes};
use bevy::mesh::{Indices, PrimitiveTopology, VertexAttributeValues};
use bevy::prelude::*;

use crate::scenes::cape::body::{Part, parts};
use crate::scenes::cape::skeleton::Joint;

/// Distance from a joint within which the skin follows its parent, too, m.
const SOFT: f32 = 0.06;

/// Draws the figure, and prints the cloths.
pub fn plugin(app: &mut App) {
    app.add_plugins(print::plugin(stage::cloth())).add_systems(PostStartup, draw_figure);
}

fn draw_figure(
    mut commands: Commands,
    joints: Query<(Entity, &Joint)>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut poses: ResMut<Assets<SkinnedMeshInverseBindposes>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let mut of_skin = vec![Entity::PLACEHOLDER; Joint::ALL.len()];
    for (entity, joint) in &joints {
        of_skin[joint.index()] = entity;
    }
    let bound: Vec<Mat4> =
        Joint::ALL.iter().map(|joint| Mat4::from_translation(-joint.place())).collect();
    let figure = StandardMaterial {
        base_color: Color::srgb(0.34, 0.36, 0.40),
        perceptual_roughness: 0.7,
        ..default()
    };
    commands.spawn((
        Mesh3d(meshes.add(mesh())),
        MeshMaterial3d(materials.add(figure)),
        SkinnedMesh { inverse_bindposes: poses.add(bound), joints: of_skin },
        NoFrustumCulling,
    ));
}

/// The mesh of all parts.
fn mesh() -> Mesh {
    let mut positions: Vec<[f32; 3]> = Vec::new();
    let mut normals: Vec<[f32; 3]> = Vec::new();
    let (mut joints, mut weights) = (Vec::new(), Vec::new());
    let mut indices = Vec::new();
    for part in parts() {
        let capsule = Mesh::from(Capsule3d::new(part.radius, 2.0 * part.half_length()));
        let pose = part.pose();
        let first = positions.len() as u32;
        for position in vectors(&capsule, Mesh::ATTRIBUTE_POSITION) {
            let at = pose.transform_point(position) + part.joint.place();
            let (of_vertex, by) = skin(&part, at);
            positions.push(at.to_array());
            joints.push(of_vertex);
            weights.push(by);
        }
        let turned = vectors(&capsule, Mesh::ATTRIBUTE_NORMAL).map(|at| pose.rotation * at);
        normals.extend(turned.map(|normal| normal.to_array()));
        let corners = capsule.indices().into_iter().flat_map(|corners| corners.iter());
        indices.extend(corners.map(|corner| first + corner as u32));
    }
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, normals)
        .with_inserted_attribute(
            Mesh::ATTRIBUTE_JOINT_INDEX,
            VertexAttributeValues::Uint16x4(joints),
        )
        .with_inserted_attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT, weights)
        .with_inserted_indices(Indices::U32(indices))
}

fn vectors(
    mesh: &Mesh,
    attribute: bevy::mesh::MeshVertexAttribute,
) -> impl Iterator<Item = Vec3> + '_ {
    let values = match mesh.attribute(attribute) {
        Some(VertexAttributeValues::Float32x3(values)) => values.as_slice(),
        _ => &[],
    };
    values.iter().copied().map(Vec3::from)
}

/// Joints and weights of a vertex of a part: near the joint, half of it follows the parent.
fn skin(part: &Part, at: Vec3) -> ([u16; 4], [f32; 4]) {
    let joint = part.joint;
    let parent = joint.parent().unwrap_or(joint);
    let far = (at.distance(joint.place()) / SOFT).min(1.0);
    let own = 0.5 + 0.5 * far;
    ([joint.index() as u16, parent.index() as u16, 0, 0], [own, 1.0 - own, 0.0, 0.0])
}
