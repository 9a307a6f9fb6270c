//! Edges of a triangle mesh, and what lies on either side of them.

use std::collections::BTreeMap;

/// An edge with the triangles on its sides.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Edge {
    pub ends: [u32; 2],
    /// The corner opposite to the edge in the first triangle.
    pub opposite: u32,
    /// The corner opposite to the edge in the second triangle; none on the border.
    pub other_opposite: Option<u32>,
}

/// All edges, in the order of their ends, so that the fabric does not depend on a hash.
///
/// # Errors
///
/// The ends of an edge that more than two triangles share.
pub(crate) fn edges(triangles: &[[u32; 3]]) -> Result<Vec<Edge>, [u32; 2]> {
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
