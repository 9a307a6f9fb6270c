//! Triangles of a curved mesh with what lies across their edges.

use glam::Vec3;

use super::topology::Edge;

/// The triangles of a mesh.
pub(in crate::fabric) struct Faces<'a> {
    positions: &'a [Vec3],
    triangles: &'a [[u32; 3]],
    /// Unit normals of the triangles.
    pub normals: Vec<Vec3>,
    /// For each side of each triangle the triangle across it; none at a border. Side k joins the corners k and k + 1.
    across: Vec<[Option<u32>; 3]>,
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
}
