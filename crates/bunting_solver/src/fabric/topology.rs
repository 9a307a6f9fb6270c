//! Edges of a triangle mesh, each with the triangles on its two sides.

/// An edge and the corners opposite to it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    /// The particles at the ends of the edge, the lower index first.
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
/// The ends of an edge with more than two triangles.
pub(super) fn edges(triangles: &[[u32; 3]]) -> Result<Vec<Edge>, [u32; 2]> {
    let corners = |&[a, b, c]: &[u32; 3]| [(a, b, c), (b, c, a), (c, a, b)];
    let sides = triangles.iter().flat_map(corners);
    let mut sides: Vec<([u32; 2], u32)> =
        sides.map(|(from, to, opposite)| ([from.min(to), from.max(to)], opposite)).collect();
    // The sort is stable: the triangles at an edge keep their order.
    sides.sort_by_key(|&(ends, _)| ends);
    let at_edges = sides.chunk_by(|(ends, _), (others, _)| ends == others);
    let edge = |sides: &[([u32; 2], u32)]| match *sides {
        [(ends, opposite)] => Ok(Edge { ends, opposite, other_opposite: None }),
        [(ends, opposite), (_, other)] => Ok(Edge { ends, opposite, other_opposite: Some(other) }),
        _ => Err(sides[0].0),
    };
    at_edges.map(edge).collect()
}
