//! Heightfields as ground: solid below their surface, whereas parry treats them as surfaces only.

use glam::Vec3;
use parry3d::query::{PointProjection, PointQuery};
use parry3d::shape::{HeightField, Triangle};

/// Greatest depth at which a particle leaves the ground by the shortest way, m; a deeper particle goes
/// straight up. Larger: queries visit more cells.
const SHALLOW: f32 = 0.25;

/// Speed at which particles deeper than [`SHALLOW`] rise, m/s. Faster: particles that are already above the
/// ground stretch the cloth.
pub(crate) const RISE_SPEED: f32 = 4.0;

/// Distance from a point up to the surface, m; negative above it, none beside the heightfield and at holes.
pub(crate) fn depth(field: &HeightField, at: Vec3) -> Option<f32> {
    let (row, column) = field.cell_at_point(at)?;
    let (left, right) = field.triangles_at(row, column);
    let heights = [left, right].into_iter().flatten().filter_map(|part| height(&part, at));
    heights.reduce(f32::max).map(|height| height - at.y)
}

/// Height of a triangle vertically above or below a point, in the field's frame, m; none if the triangle is
/// beside the point.
fn height(triangle: &Triangle, at: Vec3) -> Option<f32> {
    let (ab, ac) = (triangle.b - triangle.a, triangle.c - triangle.a);
    let ap = at - triangle.a;
    let area = ab.x * ac.z - ab.z * ac.x;
    let along_ab = (ap.x * ac.z - ap.z * ac.x) / area;
    let along_ac = (ab.x * ap.z - ab.z * ap.x) / area;
    // A point on the diagonal of a cell counts as inside of both triangles.
    const BESIDE: f32 = -1e-4;
    let inside = along_ab >= BESIDE && along_ac >= BESIDE && along_ab + along_ac <= 1.0 - BESIDE;
    inside.then_some(triangle.a.y + along_ab * ab.y + along_ac * ac.y)
}

/// Nearest permitted point for a particle that is nearer to the surface than `keep` (m) or under ground; none
/// for other particles.
pub(crate) fn project(field: &HeightField, at: Vec3, keep: f32) -> Option<PointProjection> {
    let depth = depth(field, at).filter(|&depth| depth > 0.0);
    let reach = depth.map_or(keep, |depth| depth.min(SHALLOW));
    let nearest = field.project_local_point_with_max_dist(at, false, reach);
    let Some(depth) = depth else { return nearest };
    let above = PointProjection::new(true, at + Vec3::Y * depth);
    Some(nearest.map_or(above, |nearest| PointProjection::new(true, nearest.point)))
}
