//! Merges vertices that lie on one another, as a mesh has them along its texture's seams.

use std::collections::HashMap;

use glam::{IVec3, Vec3};

/// The particle of each vertex, and the vertex that each particle stands for.
pub(crate) struct Weld {
    pub particle_of_vertex: Vec<u32>,
    pub vertex_of_particle: Vec<u32>,
}

/// Merges vertices that are at most `distance` metres apart, each into the first of its neighbours.
/// Zero merges nothing.
pub(crate) fn weld(positions: &[Vec3], distance: f32) -> Weld {
    if distance <= 0.0 {
        let each: Vec<u32> = (0..positions.len() as u32).collect();
        return Weld { particle_of_vertex: each.clone(), vertex_of_particle: each };
    }
    let cell_of = |position: Vec3| ((position - positions[0]) / distance).floor().as_ivec3();
    let mut particles_in: HashMap<IVec3, Vec<u32>> = HashMap::new();
    let mut vertex_of_particle: Vec<u32> = Vec::with_capacity(positions.len());
    let particle_of_vertex = positions
        .iter()
        .enumerate()
        .map(|(vertex, &position)| {
            let home = cell_of(position);
            let near = neighbourhood(home)
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

fn neighbourhood(home: IVec3) -> impl Iterator<Item = IVec3> {
    (-1..=1).flat_map(move |x| {
        (-1..=1).flat_map(move |y| (-1..=1).map(move |z| home.saturating_add(IVec3::new(x, y, z))))
    })
}
