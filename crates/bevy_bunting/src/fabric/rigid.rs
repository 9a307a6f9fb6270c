//! The rigid part of a mesh, and the blend between simulated and rigid vertices.

use std::collections::HashMap;

use bevy_math::Vec3;
use bunting_solver::Fabric;

/// A vertex at rest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RestVertex {
    /// Index in the mesh.
    pub vertex: u32,
    /// Position in the cloth's frame, m.
    pub position: Vec3,
    /// Unit normal in the whole mesh.
    pub normal: Vec3,
}

/// The vertices of a mesh that are not simulated, or are blended.
#[derive(Clone, Debug, Default)]
pub(crate) struct RigidPart {
    /// The vertices without particles.
    pub vertices: Vec<RestVertex>,
    /// The triangles without simulated corners, as vertices of the mesh.
    pub triangles: Vec<[u32; 3]>,
    /// Simulated vertices with a weight below 1, and their weights.
    pub blended: Vec<(RestVertex, f32)>,
    /// Least and greatest coordinates of all these vertices, m; none if there are no such vertices.
    pub bounds: Option<[Vec3; 2]>,
}

impl RigidPart {
    /// The corners of the rigid triangles, m.
    #[cfg(feature = "render")]
    pub fn corners(&self) -> Vec<[Vec3; 3]> {
        let held = self.blended.iter().map(|(rest, _)| rest);
        let mut places: Vec<(u32, Vec3)> =
            self.vertices.iter().chain(held).map(|rest| (rest.vertex, rest.position)).collect();
        places.sort_unstable_by_key(|place| place.0);
        let place = |vertex| {
            let index = places.binary_search_by_key(&vertex, |place| place.0).ok()?;
            Some(places[index].1)
        };
        let corners = self.triangles.iter().filter_map(|corners| {
            let [a, b, c] = corners.map(place);
            Some([a?, b?, c?])
        });
        corners.collect()
    }

    /// Extends the bounds to a position (m).
    pub fn extend_bounds(&mut self, position: Vec3) {
        let [low, high] = self.bounds.unwrap_or([position; 2]);
        self.bounds = Some([low.min(position), high.max(position)]);
    }
}

/// A particle that is shown between its position at rest and its simulated position.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Blend {
    particle: usize,
    /// Weight: 0 at rest, 1 simulated.
    weight: f32,
    rest: RestVertex,
}

impl Blend {
    /// The blended particles of a level with the given vertices of the mesh, ascending. If vertices were
    /// merged into one particle, the first vertex's weight is used.
    pub fn all(rigid: &RigidPart, vertices: &[u32], fabric: &Fabric) -> Vec<Self> {
        let mut blends: Vec<Self> = rigid
            .blended
            .iter()
            .filter_map(|&(rest, weight)| {
                let index = vertices.binary_search(&rest.vertex).ok()?;
                let particle = fabric.particle_of_vertex()[index] as usize;
                Some(Self { particle, weight, rest })
            })
            .collect();
        blends.sort_by_key(|blend| blend.particle);
        blends.dedup_by_key(|blend| blend.particle);
        blends
    }

    /// The blended particles of a level whose particles are not vertices, each with the weight of the vertex that is nearest to it.
    pub fn of_nearest(rigid: &RigidPart, nearest_vertices: &[u32], fabric: &Fabric) -> Vec<Self> {
        let weights: HashMap<u32, f32> =
            rigid.blended.iter().map(|(rest, weight)| (rest.vertex, *weight)).collect();
        if weights.is_empty() {
            return Vec::new();
        }
        let positions = fabric.rest_positions();
        let normals = fabric.normals(positions);
        let blend = |(particle, vertex): (usize, &u32)| {
            let weight = *weights.get(vertex)?;
            let (position, normal) = (positions[particle], normals[particle]);
            let rest = RestVertex { vertex: *vertex, position, normal };
            Some(Self { particle, weight, rest })
        };
        nearest_vertices.iter().enumerate().filter_map(blend).collect()
    }

    /// Blends the particle's simulated position (m) and normal with those at rest.
    pub fn apply(&self, positions: &mut [Vec3], normals: &mut [Vec3]) {
        let (position, normal) = (&mut positions[self.particle], &mut normals[self.particle]);
        *position = self.rest.position.lerp(*position, self.weight);
        *normal = self.rest.normal.lerp(*normal, self.weight).normalize_or_zero();
    }
}
