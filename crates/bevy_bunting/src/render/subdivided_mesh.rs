//! The mesh that shows a subdivided level of a cloth.

use bevy_math::Vec3;
use bevy_mesh::{Indices, Mesh, VertexAttributeValues};
use bunting_solver::{Stencils, Subdivision, SubdivisionBuffers};

use crate::fabric::levels::DrawnPoints;
use crate::render::level_mesh::with_vertices;

/// Makes the mesh of a subdivision of a level's mesh. Attributes of floats are interpolated; those of other formats
/// are copied from the vertex that has the greatest weight.
pub fn new(base: &Mesh, subdivision: &Subdivision) -> Mesh {
    use VertexAttributeValues::{Float32, Float32x2, Float32x3, Float32x4};

    let weights = subdivision.attributes();
    let heaviest = |row: &[(u32, f32)]| {
        row.iter().copied().max_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |term| term.0)
    };
    let nearest = weights.rows().map(heaviest).collect();
    let mut mesh = with_vertices(base.clone(), nearest);
    for (attribute, values) in base.attributes() {
        let values = match values {
            Float32(values) => {
                let values: Vec<[f32; 1]> = values.iter().map(|&value| [value]).collect();
                Float32(sums(weights, &values).into_iter().map(|[value]| value).collect())
            }
            Float32x2(values) => Float32x2(sums(weights, values)),
            Float32x3(values) => Float32x3(sums(weights, values)),
            Float32x4(values) => Float32x4(sums(weights, values)),
            _ => continue,
        };
        if attribute.id != Mesh::ATTRIBUTE_TANGENT.id {
            mesh.insert_attribute(*attribute, values);
        }
    }
    mesh.insert_indices(Indices::U32(subdivision.triangles().as_flattened().to_vec()));
    mesh
}

fn sums<const N: usize>(weights: &Stencils, values: &[[f32; N]]) -> Vec<[f32; N]> {
    let sum = |row: &[(u32, f32)]| {
        core::array::from_fn(|at| {
            row.iter().map(|&(vertex, weight)| values[vertex as usize][at] * weight).sum()
        })
    };
    weights.rows().map(sum).collect()
}

/// Whether a mesh shows the points of a level.
pub fn is_current(mesh: &Mesh, subdivision: &Subdivision, points: &DrawnPoints) -> bool {
    match mesh.try_attribute(Mesh::ATTRIBUTE_POSITION) {
        Ok(VertexAttributeValues::Float32x3(drawn)) => {
            let mut vertices = subdivision.kept().iter().zip(points.point_of_vertex);
            vertices.all(|(&vertex, &point)| {
                drawn[vertex as usize] == points.positions[point as usize].to_array()
            })
        }
        _ => true,
    }
}

/// Writes positions and normals of a surface, given by the positions of its particles, m.
pub fn write(
    mesh: &mut Mesh,
    subdivision: &Subdivision,
    positions: &[Vec3],
    buffers: &mut SubdivisionBuffers,
) {
    use VertexAttributeValues::Float32x3;

    let (mut drawn, mut normals) = (None, None);
    for (attribute, values) in mesh.attributes_mut() {
        let Float32x3(values) = values else { continue };
        if attribute.id == Mesh::ATTRIBUTE_POSITION.id {
            drawn = Some(values);
        } else if attribute.id == Mesh::ATTRIBUTE_NORMAL.id {
            normals = Some(values);
        }
    }
    let Some(drawn) = drawn else { return };
    // A mesh that was given without normals is drawn without them.
    let mut unused = Vec::new();
    let normals = normals.unwrap_or_else(|| {
        unused.resize(drawn.len(), [0.0; 3]);
        &mut unused
    });
    subdivision.evaluate(positions, buffers, drawn, normals);
}
