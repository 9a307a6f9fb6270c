//! Heightfields as ground: solid below their surface, which parry knows as a surface alone.

use glam::Vec3;
use parry3d::query::{PointProjection, PointQuery};
use parry3d::shape::{HeightField, Triangle};

/// Distance below the surface up to which a particle leaves the ground by the shortest way, m; deeper it goes
/// straight up. More makes it visit more cells.
const SHALLOW: f32 = 0.25;

/// Speed at which particles rise that are deeper than [`SHALLOW`], m/s. Cloth that rises faster is stretched
/// by the particles that are above the ground already.
pub(crate) const RISE_SPEED: f32 = 4.0;

/// Distance from a point up to the surface, m; negative above it, none beside it and at holes.
pub(crate) fn depth(field: &HeightField, at: Vec3) -> Option<f32> {
    let (row, column) = field.cell_at_point(at)?;
    let (left, right) = field.triangles_at(row, column);
    let heights = [left, right].into_iter().flatten().filter_map(|part| height(&part, at));
    heights.reduce(f32::max).map(|height| height - at.y)
}

/// Height of a triangle above or below a point, if it is.
fn height(triangle: &Triangle, at: Vec3) -> Option<f32> {
    let (ab, ac) = (triangle.b - triangle.a, triangle.c - triangle.a);
    let ap = at - triangle.a;
    let area = ab.x * ac.z - ab.z * ac.x;
    let along_ab = (ap.x * ac.z - ap.z * ac.x) / area;
    let along_ac = (ab.x * ap.z - ab.z * ap.x) / area;
    // A point on the diagonal of a cell is on either side.
    const BESIDE: f32 = -1e-4;
    let inside = along_ab >= BESIDE && along_ac >= BESIDE && along_ab + along_ac <= 1.0 - BESIDE;
    inside.then_some(triangle.a.y + along_ab * ab.y + along_ac * ac.y)
}

/// The point of the surface where a particle should go that is nearer than `keep` or under ground.
pub(crate) fn project(field: &HeightField, at: Vec3, keep: f32) -> Option<PointProjection> {
    let depth = depth(field, at).filter(|&depth| depth > 0.0);
    let reach = depth.map_or(keep, |depth| depth.min(SHALLOW));
    let nearest = field.project_local_point_with_max_dist(at, false, reach);
    let Some(depth) = depth else { return nearest };
    let above = PointProjection::new(true, at + Vec3::Y * depth);
    Some(nearest.map_or(above, |nearest| PointProjection::new(true, nearest.point)))
}
