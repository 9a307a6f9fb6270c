//! Edges of a triangle mesh, each with the triangles on its two sides.

/// An edge with its triangles and the corners opposite to it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    /// The particles at the ends of the edge, the lower index first.
    pub ends: [u32; 2],
    /// The first of its triangles.
    pub side: Side,
    /// The second triangle; none at the border of the mesh.
    pub other_side: Option<Side>,
}

/// A triangle at an edge.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side {
    pub triangle: u32,
    /// The corner opposite to the edge.
    pub opposite: u32,
}

/// The ends of an edge or a link, the lower index first.
pub(crate) fn ascending([one, other]: [u32; 2]) -> [u32; 2] {
    [one.min(other), one.max(other)]
}

/// All edges, sorted by their ends, so that a fabric does not depend on the order of a hash table.
///
/// # Errors
///
/// The ends of an edge with more than two triangles.
pub(super) fn edges(triangles: &[[u32; 3]]) -> Result<Vec<Edge>, [u32; 2]> {
    let sides_of = |(triangle, &[a, b, c]): (u32, &[u32; 3])| {
        [(a, b, c), (b, c, a), (c, a, b)]
            .map(|(from, to, opposite)| (ascending([from, to]), Side { triangle, opposite }))
    };
    let mut sides: Vec<([u32; 2], Side)> = (0..).zip(triangles).flat_map(sides_of).collect();
    // The sort is stable: the triangles at an edge keep their order.
    sides.sort_by_key(|&(ends, _)| ends);
    let at_edges = sides.chunk_by(|(ends, _), (others, _)| ends == others);
    let edge = |sides: &[([u32; 2], Side)]| match *sides {
        [(ends, side)] => Ok(Edge { ends, side, other_side: None }),
        [(ends, side), (_, other)] => Ok(Edge { ends, side, other_side: Some(other) }),
        _ => Err(sides[0].0),
    };
    at_edges.map(edge).collect()
}
