//! The nearest planes of convex polyhedra.

use glam::Vec3;
use parry3d::shape::{ConvexPolyhedron, Triangle};

use crate::constants::LEAST_LENGTH;

/// A face of a convex polyhedron.
#[derive(Clone, Copy)]
struct Face<'a> {
    shape: &'a ConvexPolyhedron,
    /// Unit normal, out of the polyhedron.
    normal: Vec3,
    /// Counterclockwise as seen from outside.
    corners: &'a [u32],
}

fn faces(shape: &ConvexPolyhedron) -> impl Iterator<Item = Face<'_>> {
    shape.faces().iter().map(|face| {
        let first = face.first_vertex_or_edge as usize;
        let range = first..first + face.num_vertices_or_edges as usize;
        Face { shape, normal: face.normal, corners: &shape.vertices_adj_to_face()[range] }
    })
}

impl<'a> Face<'a> {
    fn at(self, corner: u32) -> Vec3 {
        self.shape.points()[corner as usize]
    }

    /// Height of a point above the plane of the face, m.
    fn height(self, at: Vec3) -> f32 {
        self.normal.dot(at - self.at(self.corners[0]))
    }

    /// The ends of the edges beyond which a point is, seen from inside the face.
    fn edges_before(self, at: Vec3) -> impl Iterator<Item = [Vec3; 2]> + 'a {
        let next = self.corners.iter().cycle().skip(1);
        let ends = self.corners.iter().zip(next);
        let edges = ends.map(move |(from, to)| [self.at(*from), self.at(*to)]);
        edges.filter(move |[from, to]| (to - from).cross(at - from).dot(self.normal) < 0.0)
    }
}

/// The faces of a convex polyhedron, cut into triangles.
pub(super) fn triangles(shape: &ConvexPolyhedron) -> impl Iterator<Item = Triangle> {
    faces(shape).flat_map(|face| {
        let rest = face.corners[1..].windows(2);
        rest.map(move |ends| {
            Triangle::new(face.at(face.corners[0]), face.at(ends[0]), face.at(ends[1]))
        })
    })
}

/// Distance of a point from a convex polyhedron, m, negative inside, and the unit normal of the nearest plane.
pub(super) fn nearest(shape: &ConvexPolyhedron, at: Vec3) -> Option<(f32, Vec3)> {
    let mut highest: Option<(f32, Face)> = None;
    for face in faces(shape) {
        let height = face.height(at);
        if highest.is_none_or(|(than, _)| height > than) {
            highest = Some((height, face));
        }
    }
    let (height, face) = highest?;
    // No point is nearer than the plane that the point is highest above.
    if height <= 0.0 || face.edges_before(at).next().is_none() {
        return Some((height, face.normal));
    }
    // The nearest point lies on an edge of a face that the point is above.
    let mut nearest: Option<(f32, Vec3)> = None;
    for face in faces(shape).filter(|face| face.height(at) > 0.0) {
        for [from, to] in face.edges_before(at) {
            let along = to - from;
            let part = (at - from).dot(along) / along.length_squared().max(f32::MIN_POSITIVE);
            let away = at - (from + along * part.clamp(0.0, 1.0));
            let squared = away.length_squared();
            if nearest.is_none_or(|(than, _)| squared < than) {
                nearest = Some((squared, away));
            }
        }
    }
    let (squared, away) = nearest?;
    let distance = squared.sqrt();
    let normal = if distance > LEAST_LENGTH { away / distance } else { face.normal };
    Some((distance, normal))
}
