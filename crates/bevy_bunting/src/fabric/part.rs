//! Which part of a mesh is simulated, what stays rigid, and how the one blends into the other.

use bevy_math::Vec3;
use bunting_solver::{Fabric, FabricBuilder, FabricError};

use crate::cloth::mesh::ClothMesh;

/// Why weights cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum WeightsError {
    /// There must be one weight a vertex.
    #[error("{weights} weights for {vertices} vertices: give one a vertex, or none")]
    Count {
        /// Number of weights given.
        weights: usize,
        /// Number of vertices.
        vertices: usize,
    },
    /// A weight is not a number from 0 to 1.
    #[error("vertex {vertex} has the weight {weight}: give it one from 0, rigid, to 1, simulated")]
    OutOfRange {
        /// The vertex.
        vertex: usize,
        /// Its weight.
        weight: f32,
    },
    /// Nothing would be simulated.
    #[error("all weights are 0: give what should move a greater one, or leave out the ClothMesh")]
    AllRigid,
}

/// Checks the weights of a mesh.
///
/// # Errors
///
/// They are too few, too many, out of range or all zero.
pub(crate) fn check_weights(mesh: &ClothMesh) -> Result<(), WeightsError> {
    let (weights, vertices) = (mesh.weights(), mesh.vertex_count());
    if weights.is_empty() {
        return Ok(());
    }
    if weights.len() != vertices {
        return Err(WeightsError::Count { weights: weights.len(), vertices });
    }
    if let Some(vertex) = weights.iter().position(|weight| !(0.0..=1.0).contains(weight)) {
        return Err(WeightsError::OutOfRange { vertex, weight: weights[vertex] });
    }
    if weights.iter().all(|&weight| weight == 0.0) {
        return Err(WeightsError::AllRigid);
    }
    Ok(())
}

/// A vertex at rest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RestVertex {
    /// Its index in the mesh.
    pub vertex: u32,
    /// m.
    pub position: Vec3,
    /// Unit normal of the whole mesh.
    pub normal: Vec3,
}

/// What stays in its place.
#[derive(Clone, Debug, Default)]
pub(crate) struct RigidPart {
    /// The vertices that are not simulated.
    pub vertices: Vec<RestVertex>,
    /// The triangles that are not simulated, as vertices of the mesh.
    pub triangles: Vec<[u32; 3]>,
    /// Vertices that are simulated, but not shown quite where they are; with their weights.
    pub blended: Vec<(RestVertex, f32)>,
    /// The least and greatest coordinates of all these vertices, m; none where there are none.
    pub bounds: Option<[Vec3; 2]>,
}

/// The part of a mesh that is simulated.
#[derive(Clone, Debug)]
pub(crate) struct SimulatedPart {
    /// The part, with its pins.
    pub builder: FabricBuilder,
    /// Its vertices in the mesh, ascending.
    pub vertices: Vec<u32>,
    /// Its triangles in the mesh; empty where it is all of the mesh.
    triangles: Vec<usize>,
    /// The rest of the mesh.
    pub rigid: RigidPart,
}

impl SimulatedPart {
    /// Cuts a mesh, whose weights are good, with attached vertices.
    ///
    /// # Errors
    ///
    /// The lists of the mesh do not fit one another.
    pub fn of(mesh: &ClothMesh, attached: &[u32]) -> Result<Self, FabricError> {
        let whole = mesh.builder().pin(attached.iter().copied());
        let weights = mesh.weights();
        if weights.is_empty() {
            let vertices = (0..mesh.vertex_count() as u32).collect();
            let (triangles, rigid) = (Vec::new(), RigidPart::default());
            return Ok(Self { builder: whole, vertices, triangles, rigid });
        }
        let normals = whole.rest_normals()?;
        let mut rigid = RigidPart::default();
        let mut triangles = Vec::new();
        let mut is_simulated: Vec<bool> = weights.iter().map(|&weight| weight > 0.0).collect();
        for (triangle, corners) in whole.indices().as_chunks::<3>().0.iter().enumerate() {
            if corners.iter().all(|&corner| weights[corner as usize] == 0.0) {
                rigid.triangles.push(*corners);
            } else {
                triangles.push(triangle);
                corners.iter().for_each(|&corner| is_simulated[corner as usize] = true);
            }
        }
        let mut vertices = Vec::new();
        for (vertex, (&position, &normal)) in whole.positions().iter().zip(&normals).enumerate() {
            let rest = RestVertex { vertex: vertex as u32, position, normal };
            if weights[vertex] < 1.0 {
                let [low, high] = rigid.bounds.unwrap_or([position; 2]);
                rigid.bounds = Some([low.min(position), high.max(position)]);
            }
            if !is_simulated[vertex] {
                rigid.vertices.push(rest);
                continue;
            }
            vertices.push(rest.vertex);
            if weights[vertex] < 1.0 {
                rigid.blended.push((rest, weights[vertex]));
            }
        }
        let place = |vertex: &u32| vertices.binary_search(vertex).ok().map(|at| at as u32);
        let corners = triangles.iter().flat_map(|triangle| &whole.indices()[3 * triangle..][..3]);
        let uv = mesh.uvs();
        let held = rigid.blended.iter().filter(|(_, weight)| *weight == 0.0);
        let held = held.filter_map(|(rest, _)| place(&rest.vertex));
        let builder = FabricBuilder::new(
            vertices.iter().map(|&vertex| whole.positions()[vertex as usize]).collect(),
            corners.filter_map(place).collect(),
        )
        .uv(vertices.iter().filter_map(|&vertex| uv.get(vertex as usize).copied()).collect())
        .pin(attached.iter().filter_map(place).chain(held));
        Ok(Self { builder, vertices, triangles, rigid })
    }

    /// An error of the part's fabric, in the numbers of the mesh.
    pub fn renumber(&self, error: FabricError) -> FabricError {
        let vertex = |of_part: usize| self.vertices.get(of_part).map_or(of_part, |&v| v as usize);
        match error {
            FabricError::ZeroArea { triangle } => FabricError::ZeroArea {
                triangle: self.triangles.get(triangle).copied().unwrap_or(triangle),
            },
            FabricError::LooseVertex { vertex: loose } => {
                FabricError::LooseVertex { vertex: vertex(loose) }
            }
            FabricError::NonManifoldEdge { a, b } => {
                let [a, b] = [a, b].map(|end| vertex(end as usize) as u32);
                FabricError::NonManifoldEdge { a, b }
            }
            other => other,
        }
    }
}

/// A particle that is shown between its place at rest and where it is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Blend {
    particle: usize,
    weight: f32,
    rest: RestVertex,
}

impl Blend {
    /// Those of a level, which has some of the mesh's vertices. Of vertices that are one particle the
    /// first counts.
    pub fn all(rigid: &RigidPart, vertices: &[u32], fabric: &Fabric) -> Vec<Self> {
        let mut blends: Vec<Self> = rigid
            .blended
            .iter()
            .filter_map(|&(rest, weight)| {
                let at = vertices.binary_search(&rest.vertex).ok()?;
                let particle = fabric.particle_of_vertex()[at] as usize;
                Some(Self { particle, weight, rest })
            })
            .collect();
        blends.sort_by_key(|blend| blend.particle);
        blends.dedup_by_key(|blend| blend.particle);
        blends
    }

    /// Shows the particle where it should be seen.
    pub fn apply(&self, positions: &mut [Vec3], normals: &mut [Vec3]) {
        let (position, normal) = (&mut positions[self.particle], &mut normals[self.particle]);
        *position = self.rest.position.lerp(*position, self.weight);
        *normal = self.rest.normal.lerp(*normal, self.weight).normalize_or_zero();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A strip of four squares along x, the first two of them rigid.
    fn strip() -> ClothMesh {
        let weight = |vertex: usize| if vertex % 5 < 3 { 0.0 } else { 1.0 };
        ClothMesh::grid(5, 2, 4.0, 1.0).with_weights((0..10).map(weight).collect())
    }

    fn edit(edit: impl FnOnce(&mut Vec<Vec3>, &mut Vec<u32>)) -> ClothMesh {
        let mut mesh = strip();
        if let ClothMesh::Triangles { positions, indices, .. } = &mut mesh {
            edit(positions, indices);
        }
        mesh
    }

    #[test]
    fn only_what_moves_is_cut() {
        let part = SimulatedPart::of(&strip(), &[0, 4]).expect("a part");
        assert_eq!(part.vertices, [2, 3, 4, 7, 8, 9]);
        assert_eq!(part.rigid.triangles.len(), 4);
        let rigid: Vec<u32> = part.rigid.vertices.iter().map(|rest| rest.vertex).collect();
        assert_eq!(rigid, [0, 1, 5, 6]);
        let fabric = part.builder.build().expect("a fabric");
        assert_eq!((fabric.particle_count(), fabric.triangles().len()), (6, 4));
        // The border to the rigid part, and what is attached.
        let pinned: Vec<usize> = (0..6).filter(|&particle| fabric.is_pinned(particle)).collect();
        assert_eq!(pinned, [0, 2, 3]);
        assert_eq!(fabric.uvs()[1].x, 0.75);
    }

    #[test]
    fn errors_of_a_part_are_told_in_the_numbers_of_the_mesh() {
        let error = |mesh: ClothMesh| {
            let part = SimulatedPart::of(&mesh, &[])?;
            part.builder.clone().build().map_err(|error| part.renumber(error)).map(|_| ())
        };
        let flat = edit(|positions, _| positions[9] = positions[4]);
        let Err(FabricError::ZeroArea { triangle }) = error(flat) else { panic!("no area") };
        assert!(triangle >= 6, "{triangle}");
        let loose = edit(|_, indices| indices.retain(|&vertex| vertex != 4));
        assert!(error(loose).is_err());
        let fan = edit(|positions, indices| {
            positions[0] = Vec3::new(3.5, -0.5, 1.0);
            positions[5] = Vec3::new(3.5, -0.5, -1.0);
            indices.truncate(12);
            indices.extend([3, 8, 4, 3, 8, 0, 3, 8, 5, 3, 9, 4, 2, 7, 3]);
        });
        assert_eq!(error(fan), Err(FabricError::NonManifoldEdge { a: 3, b: 8 }));
        let far = edit(|_, indices| indices[0] = 12);
        assert!(matches!(error(far), Err(FabricError::IndexOutOfRange { vertex: 12, .. })));
        let attached = SimulatedPart::of(&strip(), &[10]).map(|_| ());
        assert_eq!(attached, Err(FabricError::PinOutOfRange { vertex: 10, vertices: 10 }));
    }

    #[test]
    fn a_particle_of_two_vertices_is_blended_once() {
        // The strip again, with vertices 3 and 8 twice, as along a seam.
        let ClothMesh::Triangles { mut positions, mut indices, mut weights, .. } = strip() else {
            unreachable!("it has weights")
        };
        positions.extend([positions[3], positions[8]]);
        for corner in indices.iter_mut().rev().take(6) {
            *corner = match *corner {
                3 => 10,
                8 => 11,
                other => other,
            };
        }
        weights.extend([0.5; 2]);
        (weights[3], weights[8]) = (0.5, 0.5);
        let mesh = ClothMesh::triangles(positions, indices, Vec::new()).with_weights(weights);
        let part = SimulatedPart::of(&mesh, &[]).expect("a part");
        let fabric = part.builder.clone().build().expect("a fabric");
        assert_eq!((part.vertices.len(), fabric.particle_count()), (8, 6));
        let blends = Blend::all(&part.rigid, &part.vertices, &fabric);
        assert_eq!(blends.len(), 4);
        let (mut positions, mut normals) = (vec![Vec3::ZERO; 6], vec![Vec3::X; 6]);
        blends.iter().for_each(|blend| blend.apply(&mut positions, &mut normals));
        assert_eq!(positions[1], 0.5 * fabric.rest_positions()[1]);
        assert!((normals[1] - Vec3::new(1.0, 0.0, 1.0).normalize()).length() < 1e-6);
        assert_eq!(positions[0], fabric.rest_positions()[0]);
        assert_eq!((positions[2], normals[0]), (Vec3::ZERO, Vec3::Z));
    }
}
