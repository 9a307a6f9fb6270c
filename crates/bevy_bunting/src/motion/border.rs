//! The borders of a mesh.

use std::collections::{HashMap, HashSet};

use bevy_math::Vec3;

use crate::cloth::mesh::ClothMesh;

/// The vertices of a mesh on the border that passes nearest to a place in its own frame, m, ascending; empty without a border.
pub(super) fn border_near(mesh: &ClothMesh, near: Vec3) -> Vec<u32> {
    let builder = mesh.builder();
    let (positions, places) = (builder.positions(), places(mesh, builder.positions()));
    let Some(neighbours) = border_neighbours(builder.indices(), &places) else { return Vec::new() };
    let on_border = (0..places.len()).filter(|&vertex| neighbours.contains_key(&places[vertex]));
    let away = |vertex: usize| positions[vertex].distance_squared(near);
    let Some(first) = on_border.min_by(|&a, &b| away(a).total_cmp(&away(b))) else {
        return Vec::new();
    };
    let mut border = HashSet::from([places[first]]);
    let mut ends = vec![places[first]];
    while let Some(place) = ends.pop() {
        let next = neighbours.get(&place).into_iter().flatten();
        ends.extend(next.filter(|&&place| border.insert(place)));
    }
    (0..).zip(&places).filter(|(_, place)| border.contains(place)).map(|it| it.0).collect()
}

/// For each vertex a number that it shares with those at the same place.
fn places(mesh: &ClothMesh, positions: &[Vec3]) -> Vec<u32> {
    if mesh.merged().len() == positions.len() {
        return mesh.merged().to_vec();
    }
    let mut known: HashMap<[u32; 3], u32> = HashMap::with_capacity(positions.len());
    let place = |(vertex, at): (u32, &Vec3)| {
        // Zero is added so that both zeros have the same bits.
        *known.entry((*at + 0.0).to_array().map(f32::to_bits)).or_insert(vertex)
    };
    (0..).zip(positions).map(place).collect()
}

/// The neighbours along borders of each place on one: edges of one triangle join them. None if an index is out of range.
fn border_neighbours(indices: &[u32], places: &[u32]) -> Option<HashMap<u32, Vec<u32>>> {
    let (triangles, _) = indices.as_chunks();
    let mut uses: HashMap<[u32; 2], u32> = HashMap::with_capacity(indices.len());
    for &[a, b, c] in triangles {
        for edge in [[a, b], [b, c], [c, a]] {
            let mut ends = [*places.get(edge[0] as usize)?, *places.get(edge[1] as usize)?];
            ends.sort_unstable();
            *uses.entry(ends).or_default() += 1;
        }
    }
    let mut neighbours: HashMap<u32, Vec<u32>> = HashMap::new();
    for [a, b] in uses.into_iter().filter(|(_, uses)| *uses == 1).map(|it| it.0) {
        neighbours.entry(a).or_default().push(b);
        neighbours.entry(b).or_default().push(a);
    }
    Some(neighbours)
}
