//! Triangles of a curved mesh with what lies across their edges, and straight walks over them.

use glam::Vec3;

use crate::fabric::topology::{Edge, ascending};

/// Least distance of a crossing from the ends of its edge, as a part of the edge. Smaller: a walk through a vertex goes
/// around it in triangles of which it crosses nothing.
const LEAST_PART: f32 = 1e-3;

/// Cosine of the angle between a direction and the edge behind it below which a walk goes straight on, instead of along
/// the direction of the triangle. Smaller: walks run to and fro between two triangles whose directions meet at an edge.
const LEAST_DEPARTURE: f32 = 0.05;

/// The triangles of a mesh.
pub(in crate::fabric) struct Faces<'a> {
    positions: &'a [Vec3],
    triangles: &'a [[u32; 3]],
    /// Unit normals of the triangles.
    pub normals: Vec<Vec3>,
    /// For each side of each triangle the triangle across it; none at a border. Side k joins the corners k and k + 1.
    across: Vec<[Option<u32>; 3]>,
}

/// A point where a straight line across triangles crosses an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Crossing {
    /// The particles at the ends of the edge.
    pub ends: [u32; 2],
    /// The point's distance from the first end, as a part of the edge.
    pub part: f32,
    /// The point, m.
    pub at: Vec3,
}

/// A point in a triangle, and a direction in its plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Heading {
    pub triangle: u32,
    /// The side on which the point lies; none if it lies within the triangle.
    pub side: Option<usize>,
    pub at: Vec3,
    pub direction: Vec3,
}

impl<'a> Faces<'a> {
    pub fn new(positions: &'a [Vec3], triangles: &'a [[u32; 3]], edges: &[Edge]) -> Self {
        let mut across = vec![[None; 3]; triangles.len()];
        for edge in edges {
            if let Some(other) = edge.other_side {
                for (here, there) in [(edge.side, other), (other, edge.side)] {
                    let triangle = here.triangle as usize;
                    let opposite = triangles[triangle].iter().position(|&at| at == here.opposite);
                    // Side k + 1 lies opposite to corner k.
                    across[triangle][(opposite.unwrap_or_default() + 1) % 3] = Some(there.triangle);
                }
            }
        }
        let corners_of = |corners: &[u32; 3]| corners.map(|corner| positions[corner as usize]);
        let normal = |corners: &[u32; 3]| {
            let [a, b, c] = corners_of(corners);
            (b - a).cross(c - a).normalize_or_zero()
        };
        Self { positions, triangles, normals: triangles.iter().map(normal).collect(), across }
    }

    pub fn count(&self) -> usize {
        self.triangles.len()
    }

    /// The particles at the corners of a triangle.
    pub fn particles(&self, triangle: u32) -> [u32; 3] {
        self.triangles[triangle as usize]
    }

    /// The corners of a triangle, m.
    pub fn corners(&self, triangle: u32) -> [Vec3; 3] {
        self.particles(triangle).map(|corner| self.positions[corner as usize])
    }

    /// The triangles across the sides of one.
    pub fn neighbours(&self, triangle: u32) -> impl Iterator<Item = u32> {
        self.across[triangle as usize].into_iter().flatten()
    }

    /// The triangle across a side of one; none at a border. Side k joins the corners k and k + 1.
    pub fn across(&self, triangle: u32, side: usize) -> Option<u32> {
        self.across[triangle as usize][side]
    }

    pub fn centre(&self, triangle: u32) -> Vec3 {
        let [a, b, c] = self.corners(triangle);
        (a + b + c) / 3.0
    }

    /// The point at which a straight line leaves its triangle, and the side of it.
    pub(super) fn exit(&self, heading: &Heading) -> (Crossing, usize) {
        let particles = self.particles(heading.triangle);
        let corners = self.corners(heading.triangle);
        let normal = self.normals[heading.triangle as usize];
        let mut best = (f32::INFINITY, 0);
        for side in (0..3).filter(|&side| Some(side) != heading.side) {
            let (from, to) = (corners[side], corners[(side + 1) % 3]);
            let inwards = normal.cross(to - from);
            let closing = -heading.direction.dot(inwards);
            let distance = (heading.at - from).dot(inwards).max(0.0) / closing;
            if closing > 0.0 && distance < best.0 {
                best = (distance, side);
            }
        }
        let (distance, side) = best;
        let ends = [particles[side], particles[(side + 1) % 3]];
        let (from, to) = (corners[side], corners[(side + 1) % 3]);
        let reached = heading.at + heading.direction * distance;
        let part = (reached - from).dot(to - from) / (to - from).length_squared();
        let part = part.clamp(LEAST_PART, 1.0 - LEAST_PART);
        (Crossing { ends, part, at: from.lerp(to, part) }, side)
    }

    /// The heading on the other side of an edge, unfolded into the plane of the triangle there; none at a border. If
    /// one of `directions` leads on from there, the one that turns least is taken.
    pub(super) fn cross(
        &self,
        heading: &Heading,
        (crossing, side): (Crossing, usize),
        directions: impl Fn(u32) -> [Vec3; 4],
    ) -> Option<Heading> {
        let triangle = self.across[heading.triangle as usize][side]?;
        let corners = self.particles(triangle);
        let entered = (0..3).find(|&side| {
            ascending([corners[side], corners[(side + 1) % 3]]) == ascending(crossing.ends)
        })?;
        let [from, to] = crossing.ends.map(|end| self.positions[end as usize]);
        let along = (to - from).normalize_or_zero();
        let [a, b, c] = self.corners(triangle);
        let third = [c, a, b][entered];
        let away = third - from;
        let inwards = (away - along * away.dot(along)).normalize_or_zero();
        let lengthwise = heading.direction.dot(along);
        let straight =
            along * lengthwise + inwards * (1.0 - lengthwise * lengthwise).max(0.0).sqrt();
        let turned = directions(triangle)
            .into_iter()
            .max_by(|one, other| one.dot(straight).total_cmp(&other.dot(straight)))
            .filter(|direction| direction.dot(inwards) > LEAST_DEPARTURE);
        let direction = turned.unwrap_or(straight);
        Some(Heading { triangle, side: Some(entered), at: crossing.at, direction })
    }
}
