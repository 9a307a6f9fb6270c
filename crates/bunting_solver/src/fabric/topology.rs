//! Edges of a triangle mesh, each with the triangles on its two sides.

use std::collections::BTreeMap;

/// An edge and the corners opposite to it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    /// The particles that it joins, the lower index first.
    pub ends: [u32; 2],
    /// The corner opposite to the edge in the first of its triangles.
    pub opposite: u32,
    /// The corner opposite to the edge in the second triangle; none at the border of the mesh.
    pub other_opposite: Option<u32>,
}

/// All edges, sorted by their ends, so that a fabric does not depend on the order of a hash table.
///
/// # Errors
///
/// The ends of an edge that more than two triangles share.
pub(super) fn edges(triangles: &[[u32; 3]]) -> Result<Vec<Edge>, [u32; 2]> {
    let mut edges: BTreeMap<[u32; 2], Edge> = BTreeMap::new();
    for &[a, b, c] in triangles {
        for (from, to, opposite) in [(a, b, c), (b, c, a), (c, a, b)] {
            let ends = [from.min(to), from.max(to)];
            match edges.get_mut(&ends) {
                None => {
                    edges.insert(ends, Edge { ends, opposite, other_opposite: None });
                }
                Some(edge) if edge.other_opposite.is_none() => edge.other_opposite = Some(opposite),
                Some(_) => return Err(ends),
            }
        }
    }
    Ok(edges.into_values().collect())
}
