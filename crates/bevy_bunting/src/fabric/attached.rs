//! What fabrics depend on of an attachment.

use bunting_solver::MeshPoint;

use crate::cloth::mesh::ClothMesh;
use crate::motion::attachment::Attachment;

/// The vertices and points at which a cloth has pins.
#[derive(Clone, Debug, Default)]
pub(crate) struct Attached {
    /// The pinned vertices.
    pub vertices: Vec<u32>,
    /// Points beside the vertices at which there are particles, and whether these are pinned: others are held by springs.
    pub points: Vec<(MeshPoint, bool)>,
}

impl Attached {
    /// Those of an attachment; none if it holds nothing.
    pub fn of(attachment: &Attachment, mesh: &ClothMesh) -> Option<Self> {
        let groups = attachment.groups(mesh);
        if groups.iter().all(|group| group.is_empty()) {
            return None;
        }
        let mut attached = Self::default();
        for (all, pinned) in groups.iter().zip(attachment.pinned_groups(mesh)) {
            let points = all.points.iter().map(|point| (*point, !pinned.points.is_empty()));
            attached.points.extend(points);
            attached.vertices.extend(pinned.vertices);
        }
        Some(attached)
    }

    /// Vertices alone.
    #[cfg(test)]
    pub fn of_vertices(vertices: &[u32]) -> Self {
        Self { vertices: vertices.to_vec(), points: Vec::new() }
    }

    /// Appends what tells it from others.
    pub fn add_key(&self, key: &mut Vec<u32>) {
        key.push(self.points.len() as u32);
        for (MeshPoint { vertices, weights }, is_pinned) in &self.points {
            key.extend(vertices);
            key.extend(weights.map(f32::to_bits));
            key.push(u32::from(*is_pinned));
        }
        key.extend(&self.vertices);
    }
}
