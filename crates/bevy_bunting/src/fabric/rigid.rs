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
    #[cfg_attr(not(feature = "render"), allow(dead_code, reason = "only drawing reads it"))]
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
    /// Position at rest, m.
    position: Vec3,
    /// Unit normal at rest.
    normal: Vec3,
}

impl Blend {
    /// The blended particles of a fabric, given the vertices of the mesh around each particle with their weights.
    pub fn all(rigid: &RigidPart, corners: &[Vec<(u32, f32)>], fabric: &Fabric) -> Vec<Self> {
        let blended =
            rigid.blended.iter().map(|(rest, weight)| (rest.vertex, (rest.normal, *weight)));
        let blended: HashMap<u32, (Vec3, f32)> = blended.collect();
        if blended.is_empty() {
            return Vec::new();
        }
        let positions = fabric.rest_positions();
        let normals = fabric.normals(positions);
        let blend = |(particle, corners): (usize, &Vec<(u32, f32)>)| {
            let (mut normal, mut weight) = (Vec3::ZERO, 0.0);
            for (vertex, part) in corners {
                let of_vertex = blended.get(vertex).copied().unwrap_or((normals[particle], 1.0));
                normal += *part * of_vertex.0;
                weight += *part * of_vertex.1;
            }
            let is_blended = corners.iter().any(|(vertex, _)| blended.contains_key(vertex));
            let (position, normal) = (positions[particle], normal.normalize_or_zero());
            is_blended.then_some(Self { particle, weight, position, normal })
        };
        corners.iter().enumerate().filter_map(blend).collect()
    }

    /// Blends the particle's simulated position (m) and normal with those at rest.
    pub fn apply(&self, positions: &mut [Vec3], normals: &mut [Vec3]) {
        let (position, normal) = (&mut positions[self.particle], &mut normals[self.particle]);
        *position = self.position.lerp(*position, self.weight);
        *normal = self.normal.lerp(*normal, self.weight).normalize_or_zero();
    }
}
