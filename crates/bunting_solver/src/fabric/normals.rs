//! Normals of a triangle mesh: the normal of a vertex is the area-weighted mean of its triangles' normals.

use glam::Vec3;

/// Unit normals of `count` vertices, from the positions (m) and the vertices of each triangle's corners. Zero
/// if the triangles of a vertex have no area.
pub(super) fn vertex_normals(
    count: usize,
    triangles: impl IntoIterator<Item = ([Vec3; 3], [u32; 3])>,
) -> Vec<Vec3> {
    let mut sums = vec![Vec3::ZERO; count];
    for ([a, b, c], vertices) in triangles {
        // The length of this normal is twice the triangle's area.
        let normal = (b - a).cross(c - a);
        for vertex in vertices {
            sums[vertex as usize] += normal;
        }
    }
    sums.into_iter().map(Vec3::normalize_or_zero).collect()
}
