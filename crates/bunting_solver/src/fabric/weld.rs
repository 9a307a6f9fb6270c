//! Merging of vertices at the same position, as along the seams of a texture.

use std::collections::HashMap;

use glam::{IVec3, Vec3};

/// Default distance at which vertices become one particle, as a part of the mesh's extent. Smaller: the rounding
/// of 32-bit positions keeps seams open. Larger: small features of large meshes collapse.
const DEFAULT_FRACTION: f32 = 1e-6;

/// Correspondence of vertices and particles.
pub(super) struct Weld {
    /// Particle of each vertex.
    pub particle_of_vertex: Vec<u32>,
    /// First vertex of each particle.
    pub vertex_of_particle: Vec<u32>,
}

impl Weld {
    /// Merges vertices that have the same number.
    pub fn by_number(numbers: &[u32]) -> Self {
        let mut particle_of = HashMap::new();
        let mut vertex_of_particle = Vec::new();
        let particle_of_vertex = (0..).zip(numbers).map(|(vertex, number)| {
            *particle_of.entry(number).or_insert_with(|| {
                vertex_of_particle.push(vertex);
                vertex_of_particle.len() as u32 - 1
            })
        });
        Self { particle_of_vertex: particle_of_vertex.collect(), vertex_of_particle }
    }
}

/// Default distance within which vertices of a mesh are merged, m.
pub(super) fn default_distance(positions: &[Vec3]) -> f32 {
    let first = positions.first().copied().unwrap_or_default();
    let (low, high) =
        positions.iter().fold((first, first), |(low, high), &p| (low.min(p), high.max(p)));
    DEFAULT_FRACTION * (high - low).max_element()
}

/// Width of the cells in which near particles are looked for, in distances of merging. Smaller: a vertex is near more cells. Larger:
/// more particles lie in each.
const CELL: f32 = 8.0;

/// How far around a vertex particles are looked for, in distances of merging. Smaller: rounding hides particles that lie as far away as
/// they may.
const REACH: f32 = 2.0;

/// Merges each vertex into the first particle at most `distance` metres away. A distance of zero merges
/// nothing.
///
/// Particles are found in cells of a hash grid.
pub(super) fn weld(positions: &[Vec3], distance: f32) -> Weld {
    if distance <= 0.0 {
        let each: Vec<u32> = (0..positions.len() as u32).collect();
        return Weld { particle_of_vertex: each.clone(), vertex_of_particle: each };
    }
    let mut particles_in: HashMap<IVec3, Vec<u32>> = HashMap::new();
    let mut vertex_of_particle: Vec<u32> = Vec::with_capacity(positions.len());
    let particle_of_vertex = positions
        .iter()
        .enumerate()
        .map(|(vertex, &position)| {
            let at = (position - positions[0]) / distance;
            let [low, home, high] =
                [-REACH, 0.0, REACH].map(|by| ((at + by) / CELL).floor().as_ivec3());
            let near = cells_between(low, high)
                .filter_map(|cell| particles_in.get(&cell))
                .flatten()
                .copied()
                .filter(|&particle| {
                    let other = positions[vertex_of_particle[particle as usize] as usize];
                    other.distance_squared(position) <= distance * distance
                })
                .min();
            near.unwrap_or_else(|| {
                let particle = vertex_of_particle.len() as u32;
                vertex_of_particle.push(vertex as u32);
                particles_in.entry(home).or_default().push(particle);
                particle
            })
        })
        .collect();
    Weld { particle_of_vertex, vertex_of_particle }
}

fn cells_between(low: IVec3, high: IVec3) -> impl Iterator<Item = IVec3> {
    (low.x..=high.x).flat_map(move |x| {
        (low.y..=high.y).flat_map(move |y| (low.z..=high.z).map(move |z| IVec3::new(x, y, z)))
    })
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use crate::fabric::FabricBuilder;

    #[test]
    fn a_seam_is_welded() {
        let seam = [
            Vec3::ZERO,
            Vec3::X,
            Vec3::Y,
            Vec3::X,
            Vec3::new(1.0, 1.0, 0.0),
            Vec3::new(1e-8, 1.0, 0.0),
        ];
        let builder = FabricBuilder::new(seam.to_vec(), vec![0, 1, 2, 3, 4, 5]);
        let (mesh, surface) = builder.rest_mesh().expect("a good mesh");
        assert_eq!(mesh.positions.len(), 4);
        assert_eq!(mesh.particle_of_vertex, [0, 1, 2, 1, 3, 2]);
        let is_inner = |edge: &&crate::fabric::topology::Edge| edge.other_side.is_some();
        assert_eq!(surface.edges.iter().filter(is_inner).count(), 1);
    }
}
