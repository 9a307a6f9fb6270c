//! The simulated part of a mesh, separated from the rigid part by the weights of the vertices (thesis, 6.1).

use bunting_solver::{FabricBuilder, FabricError, MaterialRegion, MeshPoint};

use crate::cloth::mesh::ClothMesh;
use crate::fabric::attached::Attached;
use crate::fabric::rigid::{RestVertex, RigidPart};

/// The simulated part of a mesh, and the rigid part.
#[derive(Clone, Debug)]
pub(crate) struct SimulatedPart {
    /// Builder of the part's fabric, with its pins.
    pub builder: FabricBuilder,
    /// The part's vertices as indices in the mesh, ascending.
    pub vertices: Vec<u32>,
    /// The points of the part at which there are particles, by the vertices of the mesh.
    pub points: Vec<MeshPoint>,
    /// The part's triangles as indices in the mesh; empty where the part is the whole mesh.
    triangles: Vec<usize>,
    /// The rigid part of the mesh.
    pub rigid: RigidPart,
}

impl SimulatedPart {
    /// Separates the simulated part from a mesh with valid weights, and pins what is attached. Triangles
    /// whose corners all have weight 0 are left out; vertices of weight 0 on the other triangles are pinned.
    ///
    /// # Errors
    ///
    /// The lists of the mesh do not fit one another, a position is not finite, or a point is bad.
    pub fn of(mesh: &ClothMesh, attached: &Attached) -> Result<Self, FabricError> {
        let whole = with_points(mesh.builder(), attached.points.iter().copied());
        let whole = whole.pin(attached.vertices.iter().copied());
        let weights = mesh.weights();
        if weights.is_empty() {
            let vertices = (0..mesh.vertex_count() as u32).collect();
            let (triangles, rigid) = (Vec::new(), RigidPart::default());
            let points = attached.points.iter().map(|(point, _)| *point).collect();
            return Ok(Self { builder: whole, vertices, points, triangles, rigid });
        }
        let normals = whole.rest_normals()?;
        let corners = whole.indices().as_chunks::<3>().0;
        let is_rigid = |corners: &[u32; 3]| corners.iter().all(|&it| weights[it as usize] == 0.0);
        let (rigid_triangles, triangles): (Vec<usize>, Vec<usize>) =
            (0..corners.len()).partition(|&triangle| is_rigid(&corners[triangle]));
        let mut is_simulated: Vec<bool> = weights.iter().map(|&weight| weight > 0.0).collect();
        for &corner in triangles.iter().flat_map(|&triangle| &corners[triangle]) {
            is_simulated[corner as usize] = true;
        }
        let mut rigid = RigidPart::default();
        rigid.triangles.extend(rigid_triangles.iter().map(|&triangle| corners[triangle]));
        let mut vertices = Vec::new();
        for (vertex, (&position, &normal)) in whole.positions().iter().zip(&normals).enumerate() {
            let rest = RestVertex { vertex: vertex as u32, position, normal };
            let weight = weights[vertex];
            if weight < 1.0 {
                rigid.extend_bounds(position);
            }
            if !is_simulated[vertex] {
                rigid.vertices.push(rest);
                continue;
            }
            vertices.push(rest.vertex);
            if weight < 1.0 {
                rigid.blended.push((rest, weight));
            }
        }
        let is_rigid = |vertex: u32| weights[vertex as usize] == 0.0;
        let mut points = attached.points.clone();
        points.retain(|(point, _)| !point.vertices.into_iter().all(is_rigid));
        let attached = Attached { points, vertices: attached.vertices.clone() };
        let builder = part_builder(mesh, &whole, &attached, (&vertices, &triangles), &rigid);
        let points = attached.points.into_iter().map(|(point, _)| point).collect();
        Ok(Self { builder, vertices, points, triangles, rigid })
    }

    /// The part with regions of the mesh in which the material differs.
    pub fn with_regions(mut self, regions: &[MaterialRegion]) -> Self {
        let of_part = |weights: &[f32]| -> Vec<f32> {
            self.vertices.iter().map(|&vertex| weights[vertex as usize]).collect()
        };
        let regions: Vec<MaterialRegion> =
            regions.iter().map(|region| region.map_vertices(of_part)).collect();
        self.builder = self.builder.regions(regions);
        self
    }

    /// Converts an error of the part's fabric: the part's indices become the mesh's.
    pub fn renumber(&self, error: FabricError) -> FabricError {
        let vertex = |of_part: usize| self.vertices.get(of_part).map_or(of_part, |&v| v as usize);
        let triangle = |of_part: usize| self.triangles.get(of_part).copied().unwrap_or(of_part);
        renumbered(error, vertex, triangle)
    }

    /// Checks whether a fabric of the part can be built, without building it.
    ///
    /// # Errors
    ///
    /// Those of the fabric, with the mesh's indices.
    #[cfg(feature = "render")]
    pub fn check(&self) -> Result<(), FabricError> {
        self.builder.check().map_err(|error| self.renumber(error))
    }
}

/// An error of a fabric with other numbers of its vertices and triangles.
pub(crate) fn renumbered(
    error: FabricError,
    vertex: impl Fn(usize) -> usize,
    triangle: impl Fn(usize) -> usize,
) -> FabricError {
    match error {
        FabricError::ZeroArea { triangle: flat } => {
            FabricError::ZeroArea { triangle: triangle(flat) }
        }
        FabricError::LooseVertex { vertex: loose } => {
            FabricError::LooseVertex { vertex: vertex(loose) }
        }
        FabricError::NonManifoldEdge { a, b } => {
            let [a, b] = [a, b].map(|end| vertex(end as usize) as u32);
            FabricError::NonManifoldEdge { a, b }
        }
        FabricError::OneSided { a, b } => {
            let [a, b] = [a, b].map(|end| vertex(end as usize) as u32);
            FabricError::OneSided { a, b }
        }
        FabricError::Cells { vertex: at, size } => {
            FabricError::Cells { vertex: vertex(at as usize) as u32, size }
        }
        other => other,
    }
}

/// Builder of some vertices and triangles of a mesh, both ascending. Attached vertices and vertices of weight
/// 0 are pinned.
fn part_builder(
    mesh: &ClothMesh,
    whole: &FabricBuilder,
    attached: &Attached,
    (vertices, triangles): (&[u32], &[usize]),
    rigid: &RigidPart,
) -> FabricBuilder {
    let index = |vertex: &u32| vertices.binary_search(vertex).ok().map(|index| index as u32);
    let corners = triangles.iter().flat_map(|triangle| &whole.indices()[3 * triangle..][..3]);
    let (uv, merged) = (mesh.uvs(), mesh.merged());
    let held = rigid.blended.iter().filter(|(_, weight)| *weight == 0.0);
    let held = held.filter_map(|(rest, _)| index(&rest.vertex));
    let points = attached.points.iter().map(|(point, is_pinned)| {
        let vertices = point.vertices.map(|vertex| index(&vertex).unwrap_or(vertex));
        (MeshPoint { vertices, ..*point }, *is_pinned)
    });
    let part = FabricBuilder::new(
        vertices.iter().map(|&vertex| whole.positions()[vertex as usize]).collect(),
        corners.filter_map(index).collect(),
    );
    with_points(part, points)
        .uv(vertices.iter().filter_map(|&vertex| uv.get(vertex as usize).copied()).collect())
        .merge(vertices.iter().filter_map(|&vertex| merged.get(vertex as usize).copied()).collect())
        .pin(attached.vertices.iter().filter_map(index).chain(held))
}

/// The builder with points, and whether these are pinned.
fn with_points(
    builder: FabricBuilder,
    points: impl Iterator<Item = (MeshPoint, bool)>,
) -> FabricBuilder {
    points.fold(builder, |builder, (point, is_pinned)| match is_pinned {
        true => builder.pin_points([point]),
        false => builder.free_points([point]),
    })
}

#[cfg(test)]
mod tests {
    use bevy_math::Vec3;
    use bunting_solver::Resolution;

    use super::*;
    use crate::fabric::rigid::Blend;

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
    fn the_part_has_the_triangles_with_a_simulated_corner() {
        let part = SimulatedPart::of(&strip(), &Attached::of_vertices(&[0, 4])).expect("a part");
        assert_eq!(part.vertices, [2, 3, 4, 7, 8, 9]);
        assert_eq!(part.rigid.triangles.len(), 4);
        let rigid: Vec<u32> = part.rigid.vertices.iter().map(|rest| rest.vertex).collect();
        assert_eq!(rigid, [0, 1, 5, 6]);
        assert_eq!((part.builder.particle_count(), part.builder.indices().len()), (6, 12));
        // The border to the rigid part and the attached vertices are pinned.
        let fabric = part.builder.build().expect("a fabric");
        for (vertex, &particle) in fabric.particle_of_vertex().iter().enumerate() {
            let is_pinned = [0, 2, 3].contains(&vertex);
            assert_eq!(fabric.is_pinned(particle as usize), is_pinned, "{vertex}");
        }
        let least = fabric.uvs().iter().map(|uv| uv.x).fold(1.0, f32::min);
        assert_eq!(least, 0.5, "coordinates of its right half");
    }

    #[test]
    fn errors_of_a_part_have_the_indices_of_the_mesh() {
        let error = |mesh: ClothMesh| {
            let part = SimulatedPart::of(&mesh, &Attached::default())?;
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
        let attached = SimulatedPart::of(&strip(), &Attached::of_vertices(&[10])).map(|_| ());
        assert_eq!(attached, Err(FabricError::PinOutOfRange { vertex: 10, vertices: 10 }));
    }

    #[test]
    fn particles_are_blended_as_the_vertices_around_them() {
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
        let part = SimulatedPart::of(&mesh, &Attached::default()).expect("a part");
        let mut made = part.builder.resampled(Resolution::CellSize(0.25)).expect("a fabric");
        for (vertex, _) in made.corners.iter_mut().flatten() {
            *vertex = part.vertices[*vertex as usize];
        }
        let (fabric, corners) = (&made.fabric, &made.corners);
        let blends = Blend::all(&part.rigid, corners, fabric);
        let rest = fabric.rest_positions();
        let (mut positions, mut normals) =
            (vec![Vec3::ZERO; rest.len()], vec![Vec3::X; rest.len()]);
        blends.iter().for_each(|blend| blend.apply(&mut positions, &mut normals));
        let mut between = 0;
        for (at, (position, normal)) in rest.iter().zip(positions.iter().zip(&normals)) {
            // The weight grows from 0 at x = 2 over 0.5 at x = 3 to 1 at x = 4.
            let weight = 0.5 * (at.x - 2.0);
            assert!(position.distance((1.0 - weight) * *at) < 1e-5, "{at}: {position}");
            let expected = Vec3::Z.lerp(Vec3::X, weight).normalize();
            assert!(normal.distance(expected) < 1e-5, "{at}: {normal}");
            between += usize::from(weight > 0.1 && weight < 0.4);
        }
        assert!(between >= 5, "{between} particles lie between vertices");
    }
}
